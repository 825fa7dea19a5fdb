/* A clutch between two flanges: the contact, and the centre of its disc on a radial support. The disc turns with
   flange b. The face on which it slips turns with flange a about a fixed axis. */
#include "contact.h"
#include "support.h"
#include "unit.h"

static Contact contact_of(const State *s) {
    const double *v = s->v;
    Contact contact = {
        .inner = v[V_inner_radius],
        .outer = v[V_outer_radius],
        .points = (int)v[V_contact_points],
        .angle = v[V_angle_b],
        .wear = v[V_wear] != 0.0,
        .pressure = {v[V_pressure_inner], v[V_pressure_mean], v[V_pressure_outer]},
        .friction = v[V_friction_coefficient] * v[V_engagement] * v[V_normal_load] * v[V_plates],
        .static_ratio = v[V_static_ratio],
        .epsilon = s->epsilon,
    };
    return contact;
}

static void slip_of(const double v[], double slip[3]) {
    slip[0] = v[V_vx] + v[V_speed_a] * v[V_y];
    slip[1] = v[V_vy] - v[V_speed_a] * v[V_x];
    slip[2] = v[V_speed_b] - v[V_speed_a];
}

int model_exact(const double v[]) {
    (void)v;
    return 0;
}

double model_scales(const State *s, double *length, double *speed, double *rate) {
    const double *v = s->v;
    *length = fmax(fmax(hypot(v[V_x], v[V_y]), fabs(v[V_offset])), v[V_outer_radius]);
    if (*length == 0.0) *length = 1.0;
    *speed = fmax(hypot(v[V_vx], v[V_vy]), fmax(fabs(v[V_speed_a]), fabs(v[V_speed_b])) * *length);
    if (*speed == 0.0) *speed = *length;
    *rate = 0.0;
    return 1.0;
}

void model_evaluate(State *s) {
    double *v = s->v, slip[3], force[3], elastic[2], z[2] = {v[V_x], v[V_y]}, velocity[2] = {v[V_vx], v[V_vy]};
    Contact contact = contact_of(s);
    Support support = support_of(v);
    slip_of(v, slip);
    v[V_slip_speed] = friction(&contact, slip, force, &s->slowest);
    support_force(&support, z, velocity, elastic);
    v[V_torque_a] = z[1] * force[0] - z[0] * force[1] - force[2];
    v[V_torque_b] = force[2];
    v[V_friction_x] = force[0];
    v[V_friction_y] = force[1];
    v[V_radial_force_x] = -elastic[0];
    v[V_radial_force_y] = -elastic[1];
    v[V_heat_rate] = -(force[0] * slip[0] + force[1] * slip[1] + force[2] * slip[2]);
    v[V_der_x] = velocity[0];
    v[V_der_y] = velocity[1];
    v[V_der_vx] = (force[0] + elastic[0]) / v[V_mass];
    v[V_der_vy] = (force[1] + elastic[1]) / v[V_mass];
    v[V_der_heat] = v[V_heat_rate];
}

void model_tangent(const State *s, double d[]) {
    const double *v = s->v;
    double z[2] = {v[V_x], v[V_y]}, dz[2] = {d[V_x], d[V_y]}, dv[2] = {d[V_vx], d[V_vy]}, slip[3], force[3];
    double d_force[3], elastic[2], unused, w = v[V_speed_a], dw = d[V_speed_a], d_friction;
    Contact contact = contact_of(s);
    Support support = support_of(v);
    double d_slip[3] = {dv[0] + w * dz[1] + dw * z[1], dv[1] - w * dz[0] - dw * z[0], d[V_speed_b] - dw};
    d_friction = v[V_plates] * (d[V_friction_coefficient] * v[V_engagement] * v[V_normal_load] +
                                v[V_friction_coefficient] * d[V_engagement] * v[V_normal_load] +
                                v[V_friction_coefficient] * v[V_engagement] * d[V_normal_load]);
    slip_of(v, slip);
    friction(&contact, slip, force, &unused);
    d[V_slip_speed] = friction_tangent(&contact, slip, d_slip, d_friction, d[V_angle_b], d_force);
    support_tangent(&support, z, dz, dv, elastic);
    d[V_torque_a] = dz[1] * force[0] + z[1] * d_force[0] - dz[0] * force[1] - z[0] * d_force[1] - d_force[2];
    d[V_torque_b] = d_force[2];
    d[V_friction_x] = d_force[0];
    d[V_friction_y] = d_force[1];
    d[V_radial_force_x] = -elastic[0];
    d[V_radial_force_y] = -elastic[1];
    d[V_heat_rate] = 0.0;
    for (int i = 0; i < 3; i++) d[V_heat_rate] -= d_force[i] * slip[i] + force[i] * d_slip[i];
    d[V_der_x] = dv[0];
    d[V_der_y] = dv[1];
    d[V_der_vx] = (d_force[0] + elastic[0]) / v[V_mass];
    d[V_der_vy] = (d_force[1] + elastic[1]) / v[V_mass];
    d[V_der_heat] = d[V_heat_rate];
}

int model_carried(const State *s, double t, double x[N_STATES]) {
    (void)s, (void)t, (void)x;
    return 0;
}

int model_change(State *s) {
    (void)s;
    return 0;
}
