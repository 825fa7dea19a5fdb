/* Point i is at the angle phi + 2 pi i/n and carries N/n. A point at rest about which the disc turns creeps. */
#include "points.h"
#include <math.h>

#define TURN 6.28318530717958647693

static void arm_of(const Contact *c, int i, double arm[2]) {
    double at = c->angle + TURN * i / c->points;
    arm[0] = c->outer * cos(at);
    arm[1] = c->outer * sin(at);
}

double points_slip(const Contact *c, const double slip[3], double mean[3], double *slowest) {
    double sum = 0.0;
    mean[0] = mean[1] = mean[2] = 0.0;
    *slowest = HUGE_VAL;
    for (int i = 0; i < c->points; i++) {
        double arm[2], speed, share, x, y;
        arm_of(c, i, arm);
        x = slip[0] - slip[2] * arm[1];
        y = slip[1] + slip[2] * arm[0];
        speed = hypot(x, y);
        share = 1.0 / (c->points * fmax(speed, c->epsilon));
        mean[0] += share * x;
        mean[1] += share * y;
        mean[2] += share * (arm[0] * y - arm[1] * x);
        sum += speed;
        *slowest = fmin(*slowest, speed);
    }
    return sum / c->points;
}

int points_at_rest(const Contact *c, const double slip[3]) {
    int resting = 0;
    for (int i = 0; i < c->points; i++) {
        double arm[2];
        arm_of(c, i, arm);
        if (hypot(slip[0] - slip[2] * arm[1], slip[1] + slip[2] * arm[0]) < c->epsilon) resting++;
    }
    return resting < 2 ? resting : c->points;
}

double points_slip_tangent(const Contact *c, const double slip[3], const double d[3], double d_angle,
                           double d_mean[3]) {
    double sum = 0.0;
    d_mean[0] = d_mean[1] = d_mean[2] = 0.0;
    for (int i = 0; i < c->points; i++) {
        double arm[2], d_arm[2], speed, share, x, y, dx, dy, along, d_share, fx, fy;
        arm_of(c, i, arm);
        d_arm[0] = -d_angle * arm[1];
        d_arm[1] = d_angle * arm[0];
        x = slip[0] - slip[2] * arm[1];
        y = slip[1] + slip[2] * arm[0];
        dx = d[0] - d[2] * arm[1] - slip[2] * d_arm[1];
        dy = d[1] + d[2] * arm[0] + slip[2] * d_arm[0];
        speed = hypot(x, y);
        along = speed > 0.0 ? (x * dx + y * dy) / speed : hypot(dx, dy); /* d_speed; at rest, one-sided towards d */
        share = 1.0 / (c->points * fmax(speed, c->epsilon));
        d_share = speed > c->epsilon ? -share * along / speed : 0.0;
        fx = share * dx + d_share * x;
        fy = share * dy + d_share * y;
        d_mean[0] += fx;
        d_mean[1] += fy;
        d_mean[2] += arm[0] * fy - arm[1] * fx + share * (d_arm[0] * y - d_arm[1] * x);
        sum += along;
    }
    return sum / c->points;
}
