/* Pin and disc: eq. 1 and eq. 19 of the paper. A sticking body turns with the master disc and is released as soon as the
   load exceeds the friction limit. */
#include "contact.h"
#include "points.h"
#include "support.h"
#include "unit.h"

/* Least share of the motion's size that scales errors, well above rounding. */
#define LEAST_FELT 0.1

#ifdef V_spin
#define RADIUS v[V_contact_radius]
#else
#define RADIUS 0.0
#endif

static Contact contact_of(const State *s) {
    const double *v = s->v;
    Contact contact = {.inner = RADIUS,
                       .outer = RADIUS,
#ifdef V_contact_points
                       .points = (int)v[V_contact_points],
                       .angle = v[V_angle],
#endif
                       .friction = v[V_friction_force],
                       .static_ratio = 1.0,
                       .epsilon = s->epsilon};
    return contact;
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

int model_exact(const double v[]) {
#ifdef V_contact_points
    if (v[V_contact_points] > 0.0) return 0; /* pivots about single points are not treated exactly */
#endif
    return v[V_exact] != 0.0;
}

/* The effects of friction scale with the offset and the spring's deflection under friction. If the motion is larger, as in a
   whirl, states that pass 0 are small. */
double model_scales(const State *s, double *length, double *speed, double *rate) {
    const double *v = s->v;
    double slip[3], felt = fabs(v[V_offset]);
    if (v[V_stiffness] > 0.0) felt = fmax(felt, v[V_friction_force] / v[V_stiffness]);
    slip_of(v, slip);
    *length = fmax(fmax(hypot(v[V_x], v[V_y]), fabs(v[V_offset])), RADIUS);
    if (*length == 0.0) *length = 1.0;
    *speed = fmax(hypot(v[V_vx], v[V_vy]), fabs(v[V_disc_speed]) * *length);
    *speed = fmax(*speed, RADIUS * fabs(slip[2]));
    if (*speed == 0.0) *speed = *length;
    *rate = fmax(sqrt(v[V_stiffness] / v[V_mass]), fmax(fabs(v[V_disc_speed]), v[V_damping] / v[V_mass]));
    return fmin(fmax(felt / *length, LEAST_FELT), 1.0);
}

/* Force and moment that hold the contact at rest on the master disc; returns the least mu N that can provide them. */
static double held_by(const State *s, double force[3], double by[2]) {
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
    return friction_needed(&contact, hypot(force[0], force[1]), force[2], by);
}

/* Component of slip in m/s along the holding friction; positive if the body reverses. */
static double slip_along(const double force[3], double needed, const double slip[3]) {
    return (force[0] * slip[0] + force[1] * slip[1] + force[2] * slip[2]) / needed;
}

/* Derivative of held_by along dz. */
static double held_tangent(const State *s, const double dz[2], const double force[3], const double by[2],
                           double d_force[3]) {
    const double *v = s->v;
    Support support = support_of(v);
    double w = v[V_disc_speed], z[2] = {v[V_x], v[V_y]}, turning[2] = {-w * dz[1], w * dz[0]}, elastic[2];
    double size = hypot(force[0], force[1]);
    support_tangent(&support, z, dz, turning, elastic);
    for (int i = 0; i < 2; i++) d_force[i] = -v[V_mass] * w * w * dz[i] - elastic[i];
    d_force[2] = 0.0;
    return size > 0.0 ? by[0] * (force[0] * d_force[0] + force[1] * d_force[1]) / size : 0.0;
}

static void slips(State *s, const double force[3]) {
    double *v = s->v, z[2] = {v[V_x], v[V_y]}, velocity[2] = {v[V_vx], v[V_vy]}, elastic[2];
    Support support = support_of(v);
    support_force(&support, z, velocity, elastic);
    v[V_der_x] = v[V_vx];
    v[V_der_y] = v[V_vy];
    v[V_der_vx] = (force[0] + elastic[0]) / v[V_mass];
    v[V_der_vy] = (force[1] + elastic[1]) / v[V_mass];
#ifdef V_spin
    v[V_der_angle] = v[V_spin];
    v[V_der_spin] = (force[2] - v[V_shaft_damping] * (v[V_spin] - v[V_shaft_speed])) / v[V_polar_inertia];
#endif
}

static void rests(State *s) {
    double *v = s->v, w = v[V_disc_speed];
    v[V_der_x] = -w * v[V_y];
    v[V_der_y] = w * v[V_x];
    v[V_der_vx] = -w * w * v[V_x];
    v[V_der_vy] = -w * w * v[V_y];
#ifdef V_spin
    v[V_der_angle] = w;
    v[V_der_spin] = 0.0;
#endif
}

void model_evaluate(State *s) {
    double *v = s->v, slip[3], force[3], by[2], slope[2];
    Contact contact = contact_of(s);
    slip_of(v, slip);
    if (s->mode == SLIPS) {
        v[V_slip_speed] = friction(&contact, slip, force, &s->slowest);
        v[V_indicator] = v[V_slip_speed] - s->epsilon;
        slips(s, force);
    } else {
        double needed = held_by(s, force, by);
        if (s->mode == STICKS) {
            s->slowest = v[V_slip_speed] = 0.0;
            v[V_indicator] = v[V_friction_force] - needed;
            rests(s);
        } else { /* this mode ends once the slip is fast enough, or reverses */
            double along = slip_along(force, needed, slip);
            for (int i = 0; i < 3; i++) force[i] *= v[V_friction_force] / needed;
            s->slowest = v[V_slip_speed] = slip_potential(&contact, hypot(slip[0], slip[1]), slip[2], slope);
            v[V_indicator] = fmin(s->leaving - v[V_slip_speed], s->epsilon - along);
            slips(s, force);
        }
    }
    v[V_sticks] = s->mode == STICKS;
    v[V_friction_x] = force[0];
    v[V_friction_y] = force[1];
#ifdef V_spin
    v[V_friction_moment] = force[2];
#endif
}

#ifdef V_resting_points
int model_resting(const State *s, double factor) {
    double slip[3];
    Contact contact = contact_of(s);
    contact.epsilon *= factor;
    slip_of(s->v, slip);
    return points_at_rest(&contact, slip);
}
#endif

void model_tangent(const State *s, double d[]) {
    const double *v = s->v;
    Contact contact = contact_of(s);
    Support support = support_of(v);
    double w = v[V_disc_speed], z[2] = {v[V_x], v[V_y]}, dz[2] = {d[V_x], d[V_y]}, dv[2] = {d[V_vx], d[V_vy]};
    double slip[3], d_slip[3] = {dv[0] + w * dz[1], dv[1] - w * dz[0], 0.0}, force[3], d_force[3], by[2], elastic[2];
    double d_angle = 0.0;
#ifdef V_spin
    d_slip[2] = d[V_spin];
    d_angle = d[V_angle];
#endif
    slip_of(v, slip);
    if (s->mode == SLIPS) {
        d[V_slip_speed] = friction_tangent(&contact, slip, d_slip, 0.0, d_angle, d_force);
    } else {
        double needed = held_by(s, force, by), d_needed = held_tangent(s, dz, force, by, d_force), slope[2];
        d[V_slip_speed] = 0.0;
        if (s->mode == LEAVES) {
            double U = hypot(slip[0], slip[1]);
            for (int i = 0; i < 3; i++)
                d_force[i] = v[V_friction_force] * (d_force[i] - force[i] * d_needed / needed) / needed;
            if (slip_potential(&contact, U, slip[2], slope) > 0.0)
                d[V_slip_speed] = (U > 0.0 ? slope[0] * (slip[0] * d_slip[0] + slip[1] * d_slip[1]) / U : 0.0) +
                                  (slip[2] < 0.0 ? -slope[1] : slope[1]) * d_slip[2];
        }
    }
    if (s->mode == STICKS) {
        d[V_der_x] = -w * dz[1];
        d[V_der_y] = w * dz[0];
        d[V_der_vx] = -w * w * dz[0];
        d[V_der_vy] = -w * w * dz[1];
#ifdef V_spin
        d[V_der_angle] = d[V_der_spin] = 0.0;
#endif
    } else {
        support_tangent(&support, z, dz, dv, elastic);
        d[V_der_x] = dv[0];
        d[V_der_y] = dv[1];
        d[V_der_vx] = (d_force[0] + elastic[0]) / v[V_mass];
        d[V_der_vy] = (d_force[1] + elastic[1]) / v[V_mass];
#ifdef V_spin
        d[V_der_angle] = d[V_spin];
        d[V_der_spin] = (d_force[2] - v[V_shaft_damping] * d[V_spin]) / v[V_polar_inertia];
#endif
    }
    d[V_sticks] = d[V_indicator] = 0.0;
    d[V_friction_x] = d_force[0];
    d[V_friction_y] = d_force[1];
#ifdef V_spin
    d[V_friction_moment] = d_force[2];
#endif
}

int model_carried(const State *s, double t, double x[N_STATES]) {
    const double *v = s->v;
    double w = v[V_disc_speed], turned = w * (t - v[V_stick_time]), carried[N_VARIABLES];
    if (s->mode != STICKS) return 0;
    carried[V_x] = cos(turned) * v[V_stick_x] - sin(turned) * v[V_stick_y];
    carried[V_y] = sin(turned) * v[V_stick_x] + cos(turned) * v[V_stick_y];
    carried[V_vx] = -w * carried[V_y];
    carried[V_vy] = w * carried[V_x];
#ifdef V_spin
    carried[V_angle] = v[V_stick_angle] + turned;
    carried[V_spin] = w;
#endif
    for (int i = 0; i < N_STATES; i++) x[i] = carried[STATES[i]];
    return 1;
}

int model_change(State *s) {
    double *v = s->v, force[3], slip[3], slope[2], by[2], w = v[V_disc_speed], needed, speed;
    Contact contact = contact_of(s);
    if (!s->exact) return 0;
    needed = held_by(s, force, by);
    if (s->mode == STICKS) {
        if (needed < v[V_friction_force] * (1.0 - 1e-12)) return 0;
        s->mode = LEAVES;
        v[V_release_count] += 1.0;
        v[V_release_time] = v[V_time];
        return 1;
    }
    slip_of(v, slip);
    speed = slip_potential(&contact, hypot(slip[0], slip[1]), slip[2], slope);
    /* A body that reverses with a slip above ε slides until it rests. */
    if (s->mode == LEAVES &&
        (speed >= 0.99 * s->leaving ||
         (speed > 1.01 * s->epsilon && slip_along(force, needed, slip) >= 0.99 * s->epsilon))) {
        s->mode = SLIPS;
        return 1;
    }
    if (speed > 1.01 * s->epsilon || needed >= v[V_friction_force] * (1.0 - 1e-9)) return 0;
    s->mode = STICKS;
    v[V_stick_count] += 1.0;
    v[V_stick_time] = v[V_time];
    v[V_stick_x] = v[V_x];
    v[V_stick_y] = v[V_y];
    v[V_vx] = -w * v[V_y];
    v[V_vy] = w * v[V_x];
#ifdef V_spin
    v[V_stick_angle] = v[V_angle];
    v[V_spin] = w;
#endif
    return 1;
}
