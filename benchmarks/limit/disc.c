/* The disc, one trajectory at a time and as fast as possible, as a benchmark for the lanes of reference_model/ensemble.

   The method is the same: the eighth-order Runge-Kutta method of Dormand and Prince (coefficients of Hairer's DOP853) in
   stretched time. On a ring, steps end at U = R|S|, where friction has infinite slopes. The last step ends at the final
   time. Slip only: motions are not followed to rest.

   run_discs(points, disc, starts, n, duration, tolerance, states) returns the number of steps: points is 0 for the ring;
   disc holds mass, polar inertia, stiffness, damping, friction force, disc speed, offset, contact radius, shaft damping
   and shaft speed; starts and states are n times six numbers, which are NaN where a point of the contact comes to rest. */

#include <math.h>

#include "stages.h"

enum { N = 6, ALL = 7, MOST_POINTS = 64 };

static const double ON_EDGE = 1e-4, AT_END = 1e-13, LEAST = 1e-300;
static const double REST = 1e-6; /* steps fall below it as a point of the contact comes to rest, or just before the end */

static double k2, beta, g, omega, offset, s0, eta, shaft, lag, curling;
static int points;
static double around[2 * MOST_POINTS];

static void ring(double u, double w, double *by_slip, double *by_rim) {
    double larger = u > w ? u : w, smaller = u > w ? w : u, k = smaller / larger;
    double apart = fmax((larger - smaller) / larger, 1e-16), m = k * k;
    double a = 1.0, b = sqrt(apart * (1.0 + k)), next = 0.5 * (a + b);
    b = sqrt(b);
    a = next;
    double total = m / (8.0 * a * a), rest = 0.0, weight = 1.0;
    for (;;) {
        double c = a - b;
        rest += weight * c * c;
        next = 0.5 * (a + b);
        if (c < 1e-8 * a) {
            a = next;
            break;
        }
        weight *= 2.0;
        b = sqrt(a * b);
        a = next;
    }
    if (m > 1e-4) total += rest / m;
    double by_larger = (1.0 - 0.5 * m * (1.0 + total)) / a, by_smaller = k * (0.5 - 0.5 * total) / a;
    *by_slip = u > w ? by_larger : by_smaller;
    *by_rim = u > w ? by_smaller : by_larger;
}

/* Rates of x, y, u_x, u_y, r, angle and time with respect to stretched time. */
static void rates(const double *q, double *k) {
    double x = q[0], y = q[1], ux = q[2], uy = q[3], r = q[4];
    double fx, fy, fr;
    if (points == 0) {
        double u = sqrt(ux * ux + uy * uy), w = eta * fabs(r), by_slip, by_rim;
        ring(u, w, &by_slip, &by_rim);
        double centre = by_slip / fmax(u, LEAST), turning = by_rim * eta * eta / fmax(w, LEAST);
        fx = -centre * ux, fy = -centre * uy, fr = -turning * r;
    } else {
        double c = cos(q[5]), s = sin(q[5]), px = c * ux + s * uy, py = c * uy - s * ux, rim = eta * r;
        double sx = 0.0, sy = 0.0, moment = 0.0;
        for (int i = 0; i < points; i++) {
            double cx = around[2 * i], sn = around[2 * i + 1];
            double vx = px - rim * sn, vy = py + rim * cx;
            double inverse = 1.0 / fmax(sqrt(vx * vx + vy * vy), LEAST);
            vx *= inverse, vy *= inverse;
            sx += vx, sy += vy, moment += cx * vy - sn * vx;
        }
        fx = (s * sy - c * sx) / points, fy = (-s * sx - c * sy) / points, fr = -eta * moment / points;
    }
    double slip = sqrt(ux * ux + uy * uy + r * r), share = slip / (slip + s0);
    double vx = ux - omega * y, vy = uy + omega * x;
    k[0] = share * vx;
    k[1] = share * vy;
    k[2] = share * (-k2 * (x - offset) - beta * vx + omega * vy + g * fx);
    k[3] = share * (-k2 * y - beta * vy - omega * vx + g * fy);
    k[4] = share * (-shaft * (r + lag) + g * fr);
    k[5] = share * (omega + curling * r);
    k[6] = share;
}

static double edge(const double *q, const double *k, double *rate) {
    if (points) {
        *rate = 0.0;
        return 1.0;
    }
    double u = sqrt(q[2] * q[2] + q[3] * q[3]), w = fabs(q[4]);
    *rate = (q[2] * k[2] + q[3] * k[3]) / fmax(u, LEAST) - eta * q[4] * k[4] / fmax(w, LEAST);
    return u - eta * w;
}

#define TRY(stage)                                                                        \
    for (int i = 0; i < N; i++) trial[i] = q[i] + h * STAGE_##stage;                      \
    rates(trial, k[stage]);

/* Follow q to the time end; return the number of steps. */
static long follow(double *q, double end, double tolerance) {
    double k[13][ALL], trial[ALL], h = 0.1, usual = 0.0, before, approach;
    long steps = 0;
    rates(q, k[0]);
    before = edge(q, k[0], &approach);
    while (q[6] < end - AT_END && (points == 0 || h > REST || end - q[6] < 1e-3)) {
        steps++;
        TRY(1) TRY(2) TRY(3) TRY(4) TRY(5) TRY(6) TRY(7) TRY(8) TRY(9) TRY(10) TRY(11)
        for (int i = 0; i < ALL; i++) trial[i] = q[i] + h * MEAN;
        rates(trial, k[12]);
        double high = 0.0, low = 0.0;
        for (int i = 0; i < ALL; i++) {
            double size = 1.0 + (i < 5 ? fmax(fabs(q[i]), fabs(trial[i])) : 0.0);
            double fifth = FIFTH / size, third = THIRD / size;
            high += fifth * fifth;
            low += third * third;
        }
        double error = h * high / (sqrt((high + 0.01 * low) * ALL + 1e-300) * tolerance);
        double factor = 0.9 / sqrt(sqrt(sqrt(fmax(error, 1e-30))));
        double next = h * fmin(fmax(factor, 0.2), 10.0);
        if (!(error < 1.0)) {
            h = next;
            continue;
        }
        if (trial[6] > end + AT_END) {
            h *= (end - q[6]) / (trial[6] - q[6]);
            continue;
        }
        double leaving, after = edge(trial, k[12], &leaving);
        if (before * after < 0.0 && fmin(fabs(before), fabs(after)) > ON_EDGE * fabs(after - before)) {
            double slope = approach * h, bend = after - before - slope;
            double root = sqrt(fmax(slope * slope - 4.0 * bend * before, 0.0));
            double share = approach * before < 0.0 ? fabs(2.0 * before) / (fabs(slope) + root + LEAST) : 0.5;
            usual = fmax(usual, h);
            h *= fmin(fmax(share, 0.01), 0.99);
            continue;
        }
        for (int i = 0; i < ALL; i++) q[i] = trial[i], k[0][i] = k[12][i];
        before = after, approach = leaving;
        h = fmin(fmax(next, usual), (end - q[6]) / fmax(k[0][6], LEAST));
        usual = 0.0;
    }
    if (q[6] < end - AT_END) q[0] = NAN;
    return steps;
}

long run_discs(int number, const double *disc, const double *starts, long n, double duration, double tolerance,
               double *states) {
    points = number;
    for (int i = 0; i < points; i++) {
        around[2 * i] = cos(2.0 * M_PI * i / points);
        around[2 * i + 1] = sin(2.0 * M_PI * i / points);
    }
    long steps = 0;
    double kappa = sqrt(disc[1] / disc[0]), rate = fmax(sqrt(disc[2] / disc[0]), fabs(disc[5])), force = disc[4] / disc[0];
    for (long j = 0; j < n; j++) {
        const double *s = starts + 6 * j;
        double length = fmax(fmax(hypot(s[0], s[1]), fabs(disc[6])), fmax(hypot(s[3], s[4]) / rate, force / (rate * rate)));
        double speed = length * rate;
        k2 = disc[2] / disc[0] / (rate * rate), beta = disc[3] / disc[0] / rate, g = force / (speed * rate), omega = disc[5] / rate;
        offset = disc[6] / length, s0 = 0.5 * g, eta = disc[7] / kappa, shaft = disc[8] / disc[1] / rate;
        lag = kappa * (disc[5] - disc[9]) / speed, curling = length / kappa;
        double q[ALL] = {s[0] / length, s[1] / length, (s[3] + disc[5] * s[1]) / speed, (s[4] - disc[5] * s[0]) / speed,
                         kappa * (s[5] - disc[5]) / speed, s[2], 0.0};
        steps += follow(q, duration * rate, tolerance);
        double *end = states + 6 * j;
        end[0] = q[0] * length, end[1] = q[1] * length, end[2] = q[5];
        end[3] = (q[2] - omega * q[1]) * speed, end[4] = (q[3] + omega * q[0]) * speed;
        end[5] = (omega + curling * q[4]) * rate;
    }
    return steps;
}
