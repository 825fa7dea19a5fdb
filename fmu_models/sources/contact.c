/* The ring by the arithmetic-geometric mean, the annulus by Gaussian quadrature over rings.

   The mean slip speed of a ring is P(U, W) = (2/pi) L [2 E(k) - (1 - k^2) K(k)], where L is the larger and k L the
   smaller of U and W. This is Landen's transformation of (2/pi) (U + W) E. It follows that dP/dL = (2/pi) E and
   dP/d(kL) = (2/pi) [E - (1 - k^2) K]/k. From a_0 = 1, b_0 = sqrt(1 - k^2), c_0 = k and c_n+1 = c_n^2/(4 a_n+1), the
   mean A gives K = pi/(2 A) and K - E = K (k^2/2 + k^2 T), k^2 T = sum over n >= 1 of 2^(n-1) c_n^2 (DLMF 19.8.6).
   Nearly equal numbers are subtracted only where a logarithm dominates the cancellation error. */
#include "contact.h"
#include "points.h"
#include "variables.h"
#include <math.h>

#define NEAREST 1e-15   /* relative distance from U = W below which the curvature, a logarithm, is cut off */
#define ROUNDING 1e-2   /* rounding of the corner of the static peak, as slip speed over epsilon */
#define FARTHEST 4.0    /* largest radius at rest, over the outer radius, that refines the quadrature */

static double mean_of(double k, double complement, double *T) {
    double a = 1.0, b = sqrt(complement), c = k, weight = 0.5, sum = 0.0;
    while (c > 1e-9) {
        double next = 0.5 * (a + b);
        b = sqrt(a * b);
        a = next;
        c = c * c / (4.0 * a);
        weight *= 2.0;
        sum += weight * c * c;
    }
    /* for small k the first term, k^2/16 times k^2, is sufficient */
    *T = k > 1e-7 ? sum / (k * k) : k * k / 16.0;
    return a;
}

void ring_slopes(double U, double W, double slope[2]) {
    double larger = U > W ? U : W, smaller = U > W ? W : U, k = smaller / larger;
    double complement = (larger - smaller) / larger * (1.0 + k), by_larger, by_smaller;
    if (complement <= 0.0) {
        by_larger = by_smaller = 0.63661977236758134308; /* 2/pi */
    } else {
        double T, A = mean_of(k, complement, &T);
        by_larger = (1.0 - k * k * (0.5 + T)) / A;
        by_smaller = k * (0.5 - T) / A;
    }
    slope[0] = U > W ? by_larger : by_smaller;
    slope[1] = U > W ? by_smaller : by_larger;
}

void ring_curvatures(double U, double W, double curvature[3]) {
    double larger = U > W ? U : W, smaller = U > W ? W : U, k = smaller / larger, T, A, sharp;
    A = mean_of(k, fmax((larger - smaller) / larger, NEAREST) * (1.0 + k), &T);
    sharp = (0.5 + T) / (A * larger); /* d2P by the smaller; the others follow because slopes have degree 0 */
    curvature[0] = U > W ? k * k * sharp : sharp;
    curvature[1] = -k * sharp;
    curvature[2] = U > W ? sharp : k * k * sharp;
}

/* Share of the load per m of radius r in m; normalised by Simpson's rule, which is exact for a cubic. */
static double share_at(const Contact *c, double r) {
    double width = c->outer - c->inner, s = (r - c->inner) / width, a = c->inner, b = c->outer, whole;
    double inner = c->pressure[0], mean = c->pressure[1], outer = c->pressure[2];
    double pressure = inner * (1.0 - s) * (1.0 - 2.0 * s) + 4.0 * mean * s * (1.0 - s) + outer * s * (2.0 * s - 1.0);
    whole = c->wear ? inner + 4.0 * mean + outer : a * inner + 2.0 * (a + b) * mean + b * outer;
    return 6.0 * (c->wear ? pressure : r * pressure) / (width * whole);
}

/* Adds slopes and curvatures of the rings on one side of the radius at rest. */
static void add_side(const Contact *c, double U, double S, double rest, double near, double far, double slope[2],
                     double *curvature) {
    /* r = rest + (far - rest) t^3 concentrates the rings near the radius at rest */
    double length = far - rest, from = cbrt((near - rest) / length);
    for (int i = 0; i < N_GAUSS; i++) {
        double t = from + (1.0 - from) * GAUSS_PLACES[i], r = rest + length * t * t * t, by[2], twice[3];
        double share = (1.0 - from) * GAUSS_WEIGHTS[i] * 3.0 * t * t * fabs(length) * share_at(c, r);
        ring_slopes(U, r * S, by);
        slope[0] += share * by[0];
        slope[1] += share * r * by[1];
        if (curvature) {
            ring_curvatures(U, r * S, twice);
            curvature[0] += share * twice[0];
            curvature[1] += share * r * twice[1];
            curvature[2] += share * r * r * twice[2];
        }
    }
}

/* Slopes, and curvatures unless the pointer is 0, at U, S >= 0, not both 0. */
static void derivatives(const Contact *c, double U, double S, double slope[2], double *curvature) {
    if (c->outer == 0.0) {
        slope[0] = 1.0, slope[1] = 0.0;
        if (curvature) curvature[0] = curvature[1] = curvature[2] = 0.0;
    } else if (c->inner == c->outer) {
        double R = c->outer;
        ring_slopes(U, R * S, slope);
        slope[1] *= R;
        if (curvature) {
            ring_curvatures(U, R * S, curvature);
            curvature[1] *= R, curvature[2] *= R * R;
        }
    } else {
        double rest = U < FARTHEST * c->outer * S ? U / S : FARTHEST * c->outer;
        slope[0] = slope[1] = 0.0;
        if (curvature) curvature[0] = curvature[1] = curvature[2] = 0.0;
        if (rest > c->inner) add_side(c, U, S, rest, fmin(rest, c->outer), c->inner, slope, curvature);
        if (rest < c->outer) add_side(c, U, S, rest, fmax(rest, c->inner), c->outer, slope, curvature);
    }
}

double slip_potential(const Contact *contact, double U, double S, double slope[2]) {
    if (U == 0.0 && S == 0.0) {
        slope[0] = slope[1] = 0.0;
        return 0.0;
    }
    derivatives(contact, U, fabs(S), slope, 0);
    return slope[0] * U + slope[1] * fabs(S);
}

/* Friction over sliding friction at share = P/epsilon, and its derivative; it falls like a root from share 1 to 2. */
static double peak(double share, double static_ratio, double *by_share) {
    double root, full;
    *by_share = 0.0;
    if (share < 1.0) return static_ratio;
    if (share >= 2.0) return 1.0;
    root = sqrt(share - 1.0 + ROUNDING * ROUNDING);
    full = sqrt(1.0 + ROUNDING * ROUNDING) - ROUNDING;
    *by_share = -(static_ratio - 1.0) / (2.0 * root * full);
    return static_ratio - (static_ratio - 1.0) * (root - ROUNDING) / full;
}

/* Friction over mu N of a contact without points, viscous as a whole at shares below 1. */
static double law(double share, double static_ratio, double *by_share) {
    double found = peak(share, static_ratio, by_share);
    if (share >= 1.0) return found;
    *by_share = static_ratio;
    return static_ratio * share;
}

double friction(const Contact *contact, const double slip[3], double force[3], double *slowest) {
    double slope[2], unused, U = hypot(slip[0], slip[1]), P, factor, along;
    if (contact->points > 0) {
        P = points_slip(contact, slip, force, slowest);
        factor = -contact->friction * peak(P / contact->epsilon, contact->static_ratio, &unused);
        for (int i = 0; i < 3; i++) force[i] *= factor;
        return P;
    }
    *slowest = P = slip_potential(contact, U, slip[2], slope);
    factor = -contact->friction * law(P / contact->epsilon, contact->static_ratio, &unused);
    along = U > 0.0 ? factor * slope[0] / U : 0.0;
    force[0] = along * slip[0];
    force[1] = along * slip[1];
    force[2] = factor * (slip[2] < 0.0 ? -slope[1] : slope[1]);
    return P;
}

static double tangent_of_points(const Contact *contact, const double slip[3], const double d[3], double d_friction,
                                double d_angle, double d_force[3]) {
    double mean[3], slowest, by_share, P = points_slip(contact, slip, mean, &slowest);
    double factor = peak(P / contact->epsilon, contact->static_ratio, &by_share);
    double dP = points_slip_tangent(contact, slip, d, d_angle, d_force);
    double d_factor = d_friction * factor + contact->friction * by_share * dP / contact->epsilon;
    for (int i = 0; i < 3; i++) d_force[i] = -contact->friction * factor * d_force[i] - d_factor * mean[i];
    return dP;
}

double friction_tangent(const Contact *contact, const double slip[3], const double d[3], double d_friction,
                        double d_angle, double d_force[3]) {
    double U = hypot(slip[0], slip[1]), S = fabs(slip[2]), sign = slip[2] < 0.0 ? -1.0 : 1.0;
    double slope[2], twice[3], by_share, ex, ey, dU, dS, dP, factor, d_factor, d_along, across, unused;
    if (contact->points > 0) return tangent_of_points(contact, slip, d, d_friction, d_angle, d_force);
    if (U == 0.0 && S == 0.0) { /* friction has degree 1 below epsilon, so its derivative is the force at slip d */
        Contact one = *contact;
        dP = slip_potential(contact, hypot(d[0], d[1]), d[2], slope);
        one.friction *= contact->static_ratio * dP / contact->epsilon;
        one.static_ratio = 1.0;
        one.epsilon = 0.5 * dP > 0.0 ? 0.5 * dP : 1.0;
        friction(&one, d, d_force, &unused);
        return dP;
    }
    derivatives(contact, U, S, slope, twice);
    ex = U > 0.0 ? slip[0] / U : 1.0;
    ey = U > 0.0 ? slip[1] / U : 0.0;
    dU = ex * d[0] + ey * d[1];
    dS = sign * d[2];
    dP = slope[0] * dU + slope[1] * dS;
    factor = law((slope[0] * U + slope[1] * S) / contact->epsilon, contact->static_ratio, &by_share);
    d_factor = -d_friction * factor - contact->friction * by_share * dP / contact->epsilon;
    factor *= -contact->friction;
    d_along = d_factor * slope[0] + factor * (twice[0] * dU + twice[1] * dS);
    across = factor * (U > 0.0 ? slope[0] / U : twice[0]) * (ex * d[1] - ey * d[0]);
    d_force[0] = d_along * ex - across * ey;
    d_force[1] = d_along * ey + across * ex;
    d_force[2] = sign * (d_factor * slope[1] + factor * (twice[1] * dU + twice[2] * dS));
    return dP;
}

double friction_needed(const Contact *contact, double force, double moment, double by[2]) {
    /* Maximise (F U + M S)/P(U, S) by golden sections: P is convex, so there is one maximum. */
    double golden = 0.61803398874989484820, low = 0.0, high = 1.57079632679489661923, best = -1.0, slope[2];
    by[0] = 1.0, by[1] = 0.0;
    if (contact->outer == 0.0) return force;
    for (int turn = 0; turn < 50; turn++) {
        double at[2] = {high - golden * (high - low), low + golden * (high - low)}, value[2];
        for (int i = 0; i < 2; i++) {
            double U = cos(at[i]), S = sin(at[i]) / contact->outer, P = slip_potential(contact, U, S, slope);
            value[i] = (force * U + fabs(moment) * S) / P;
            if (value[i] > best) {
                best = value[i];
                by[0] = U / P;
                by[1] = moment < 0.0 ? -S / P : S / P;
            }
        }
        if (value[0] > value[1]) high = at[1];
        else low = at[0];
    }
    return best;
}
