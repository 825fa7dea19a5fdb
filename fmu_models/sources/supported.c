/* pin and disc: eq. 1 and eq. 19 of the paper. What sticks turns with the disc below, and is let go as soon as that
   takes more than friction has. */
#include "contact.h"
#include "support.h"
#include "unit.h"

#ifdef V_spin
#define SPIN v[V_spin]
#define RADIUS v[V_contact_radius]
#else
#define SPIN 0.0
#define RADIUS 0.0
#endif

static Contact contact_of(const State *s) {
    const double *v = s->v;
    Contact contact = {RADIUS, RADIUS, 0, v[V_friction_force], 1.0, s->epsilon};
    return contact;
}

static Support support_of(const double v[]) {
    Support support = {v[V_stiffness], v[V_damping],  v[V_offset],
                       v[V_hardening], v[V_stop_gap], v[V_stop_stiffness]};
    return support;
}

static void slip_of(const double v[], double slip[3]) {
    slip[0] = v[V_vx] + v[V_disc_speed] * v[V_y];
    slip[1] = v[V_vy] - v[V_disc_speed] * v[V_x];
#ifdef V_spin
    slip[2] = v[V_spin] - v[V_disc_speed];
#else
    slip[2] = 0.0;
#endif
}

const char *model_refusal(const double v[]) {
    (void)v;
    return 0;
}

void model_scales(const State *s, double *length, double *speed) {
    const double *v = s->v;
    double slip[3];
    slip_of(v, slip);
    *length = fmax(fmax(hypot(v[V_x], v[V_y]), fabs(v[V_offset])), RADIUS);
    if (*length == 0.0) *length = 1.0;
    *speed = fmax(hypot(v[V_vx], v[V_vy]), fabs(v[V_disc_speed]) * *length);
    *speed = fmax(*speed, RADIUS * fabs(slip[2]));
    if (*speed == 0.0) *speed = *length;
}

/* Forces and moment that hold the contact at rest on the disc below. */
static double held_by(const State *s, double force[3]) {
    const double *v = s->v;
    Contact contact = contact_of(s);
    Support support = support_of(v);
    double w = v[V_disc_speed], z[2] = {v[V_x], v[V_y]}, turning[2] = {-w * v[V_y], w * v[V_x]}, elastic[2];
    support_force(&support, z, turning, elastic);
    force[0] = -v[V_mass] * w * w * v[V_x] - elastic[0];
    force[1] = -v[V_mass] * w * w * v[V_y] - elastic[1];
#ifdef V_spin
    force[2] = v[V_shaft_damping] * (w - v[V_shaft_speed]);
#else
    force[2] = 0.0;
#endif
    return friction_needed(&contact, hypot(force[0], force[1]), force[2]);
}

void model_evaluate(State *s) {
    double *v = s->v, slip[3], force[3], elastic[2], w = v[V_disc_speed];
    Contact contact = contact_of(s);
    Support support = support_of(v);
    if (s->sticks) {
        double needed = held_by(s, force);
        v[V_slip_speed] = 0.0;
        v[V_indicator] = v[V_friction_force] - needed;
        v[V_der_x] = -w * v[V_y];
        v[V_der_y] = w * v[V_x];
        v[V_der_vx] = -w * w * v[V_x];
        v[V_der_vy] = -w * w * v[V_y];
#ifdef V_spin
        v[V_der_angle] = w;
        v[V_der_spin] = 0.0;
#endif
    } else {
        double z[2] = {v[V_x], v[V_y]}, velocity[2] = {v[V_vx], v[V_vy]};
        slip_of(v, slip);
        v[V_slip_speed] = friction(&contact, slip, force);
        support_force(&support, z, velocity, elastic);
        v[V_indicator] = v[V_slip_speed] - s->epsilon;
        v[V_der_x] = v[V_vx];
        v[V_der_y] = v[V_vy];
        v[V_der_vx] = (force[0] + elastic[0]) / v[V_mass];
        v[V_der_vy] = (force[1] + elastic[1]) / v[V_mass];
#ifdef V_spin
        v[V_der_angle] = v[V_spin];
        v[V_der_spin] = (force[2] - v[V_shaft_damping] * (v[V_spin] - v[V_shaft_speed])) / v[V_polar_inertia];
#endif
    }
    v[V_sticks] = s->sticks;
    v[V_friction_x] = force[0];
    v[V_friction_y] = force[1];
#ifdef V_spin
    v[V_friction_moment] = force[2];
#endif
}

void model_tangent(const State *s, double d[]) {
    const double *v = s->v;
    Contact contact = contact_of(s);
    Support support = support_of(v);
    double w = v[V_disc_speed], dz[2] = {d[V_x], d[V_y]}, z[2] = {v[V_x], v[V_y]}, force[3], elastic[2];
    d[V_sticks] = 0.0;
    if (s->sticks) {
        double turning[2] = {-w * dz[1], w * dz[0]};
        support_tangent(&support, z, dz, turning, elastic);
        force[0] = -v[V_mass] * w * w * dz[0] - elastic[0];
        force[1] = -v[V_mass] * w * w * dz[1] - elastic[1];
        force[2] = 0.0;
        d[V_slip_speed] = 0.0;
        d[V_der_x] = turning[0];
        d[V_der_y] = turning[1];
        d[V_der_vx] = -w * w * dz[0];
        d[V_der_vy] = -w * w * dz[1];
#ifdef V_spin
        d[V_der_angle] = d[V_der_spin] = 0.0;
#endif
    } else {
        double dv[2] = {d[V_vx], d[V_vy]}, slip[3], d_slip[3] = {dv[0] + w * dz[1], dv[1] - w * dz[0], 0.0};
#ifdef V_spin
        d_slip[2] = d[V_spin];
#endif
        slip_of(v, slip);
        d[V_slip_speed] = friction_tangent(&contact, slip, d_slip, 0.0, force);
        support_tangent(&support, z, dz, dv, elastic);
        d[V_der_x] = dv[0];
        d[V_der_y] = dv[1];
        d[V_der_vx] = (force[0] + elastic[0]) / v[V_mass];
        d[V_der_vy] = (force[1] + elastic[1]) / v[V_mass];
#ifdef V_spin
        d[V_der_angle] = d[V_spin];
        d[V_der_spin] = (force[2] - v[V_shaft_damping] * d[V_spin]) / v[V_polar_inertia];
#endif
    }
    d[V_friction_x] = force[0];
    d[V_friction_y] = force[1];
#ifdef V_spin
    d[V_friction_moment] = force[2];
#endif
}

int model_change(State *s) {
    double *v = s->v, force[3], slip[3], slope[2], w = v[V_disc_speed], needed;
    Contact contact = contact_of(s);
    if (v[V_exact] == 0.0) return 0;
    needed = held_by(s, force);
    if (s->sticks) {
        if (needed < v[V_friction_force] * (1.0 - 1e-12)) return 0;
        s->sticks = 0;
        return 1;
    }
    slip_of(v, slip);
    if (slip_potential(&contact, hypot(slip[0], slip[1]), slip[2], slope) > 1.01 * s->epsilon) return 0;
    if (needed >= v[V_friction_force] * (1.0 - 1e-9)) return 0;
    s->sticks = 1;
    v[V_vx] = -w * v[V_y];
    v[V_vy] = w * v[V_x];
#ifdef V_spin
    v[V_spin] = w;
#endif
    return 1;
}
