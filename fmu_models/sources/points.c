/* Point i is at the angle phi + 2 pi i/n and carries N/n. One that rests while the disc turns about it creeps. */
#include "points.h"
#include <math.h>

#define TURN 6.28318530717958647693

static void arm_of(const Points *c, int i, double angle, double arm[2]) {
    double at = angle + TURN * i / c->points;
    arm[0] = c->radius * cos(at);
    arm[1] = c->radius * sin(at);
}

double points_friction(const Points *c, double angle, const double slip[3], double force[3], double *least) {
    double sum = 0.0, share = c->friction / c->points;
    force[0] = force[1] = force[2] = 0.0;
    *least = HUGE_VAL;
    for (int i = 0; i < c->points; i++) {
        double arm[2], speed, factor, x, y;
        arm_of(c, i, angle, arm);
        x = slip[0] - slip[2] * arm[1];
        y = slip[1] + slip[2] * arm[0];
        speed = hypot(x, y);
        factor = -share / fmax(speed, c->epsilon);
        force[0] += factor * x;
        force[1] += factor * y;
        force[2] += factor * (arm[0] * y - arm[1] * x);
        sum += speed;
        *least = fmin(*least, speed);
    }
    return sum / c->points;
}

double points_tangent(const Points *c, double angle, double d_angle, const double slip[3], const double d[3],
                      double d_force[3]) {
    double sum = 0.0, share = c->friction / c->points;
    d_force[0] = d_force[1] = d_force[2] = 0.0;
    for (int i = 0; i < c->points; i++) {
        double arm[2], d_arm[2], speed, factor, x, y, dx, dy, along, d_factor, fx, fy;
        arm_of(c, i, angle, arm);
        d_arm[0] = -d_angle * arm[1];
        d_arm[1] = d_angle * arm[0];
        x = slip[0] - slip[2] * arm[1];
        y = slip[1] + slip[2] * arm[0];
        dx = d[0] - d[2] * arm[1] - slip[2] * d_arm[1];
        dy = d[1] + d[2] * arm[0] + slip[2] * d_arm[0];
        speed = hypot(x, y);
        along = speed > 0.0 ? (x * dx + y * dy) / speed : hypot(dx, dy); /* d_speed; at rest to the side of d */
        factor = -share / fmax(speed, c->epsilon);
        d_factor = speed > c->epsilon ? -factor * along / speed : 0.0;
        fx = factor * dx + d_factor * x;
        fy = factor * dy + d_factor * y;
        d_force[0] += fx;
        d_force[1] += fy;
        d_force[2] += arm[0] * fy - arm[1] * fx + factor * (d_arm[0] * y - d_arm[1] * x);
        sum += along;
    }
    return sum / c->points;
}
