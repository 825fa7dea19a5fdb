/* The radial support: a spring that may harden, a stop and a damper. */
#ifndef SUPPORT_H
#define SUPPORT_H
#include "variables.h"
#include <math.h>

typedef struct {
    double stiffness, damping, offset, hardening, stop_gap, stop_stiffness;
} Support;

static Support support_of(const double v[]) {
    Support support = {v[V_stiffness], v[V_damping],  v[V_offset],
                       v[V_hardening], v[V_stop_gap], v[V_stop_stiffness]};
    return support;
}

static double secant_of(const Support *p, double d) {
    double secant = p->stiffness + p->hardening * d * d;
    if (d > p->stop_gap) secant += p->stop_stiffness * (1.0 - p->stop_gap / d);
    return secant;
}

/* Force in N at a position z (m) and velocity v (m/s). */
static void support_force(const Support *p, const double z[2], const double v[2], double force[2]) {
    double w = z[0] - p->offset, secant = secant_of(p, hypot(w, z[1]));
    force[0] = -secant * w - p->damping * v[0];
    force[1] = -secant * z[1] - p->damping * v[1];
}

/* Derivative of the force along dz and dv. */
static void support_tangent(const Support *p, const double z[2], const double dz[2], const double dv[2],
                            double d_force[2]) {
    double w[2] = {z[0] - p->offset, z[1]}, d = hypot(w[0], w[1]), secant = secant_of(p, d);
    double slope = 2.0 * p->hardening * d; /* d secant/dd */
    double d_secant;
    if (d > p->stop_gap) slope += p->stop_stiffness * p->stop_gap / (d * d);
    d_secant = d > 0.0 ? slope * (w[0] * dz[0] + w[1] * dz[1]) / d : 0.0;
    for (int i = 0; i < 2; i++) d_force[i] = -secant * dz[i] - d_secant * w[i] - p->damping * dv[i];
}

#endif
