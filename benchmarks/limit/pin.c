/* The pin under exact Coulomb friction, handwritten: the practical limit for reference_model.ensemble, at full length and
 * without detecting end states.
 *
 * The scheme is the same: DOP853 in stretched time in two vectors of eight lanes, refilled as trajectories finish, with
 * closed-form stick phases and a series at the start of slip. (The regularised law, by DOP853 and Rodas5P, is slower.)
 * The tolerance is relative to the size of each motion, as in the package.
 */
#include <complex.h>
#include <math.h>
#include <string.h>

#include "dop853.h"
#include "lanes.h"

typedef double complex cplx;

#define TERMS 8
#define MOST_TERMS 20

typedef struct { double k2, c, g, omega, offset, rate, s0; } law_t;

typedef struct { vec v[6]; } rates_t; /* rates of x, y, wx, wy; dt/dtau; dt/dtau times the slip speed */

INLINE rates_t rates(vec x, vec y, vec wx, vec wy, const law_t *p)
{
    vec s = root(wx * wx + wy * wy), pace = 1.0 / (s + p->s0), share = s * pace;
    vec vx = wx - p->omega * y, vy = wy + p->omega * x, f = p->g * pace;
    vec ax = -p->k2 * (x - p->offset) - p->c * vx + p->omega * vy;
    vec ay = -p->k2 * y - p->c * vy - p->omega * vx;
    return (rates_t){{share * vx, share * vy, share * ax - f * wx, share * ay - f * wy, share, share * s}};
}

typedef struct { vec y[4], t, k[6], h, unit; } lanes_t; /* unit: unit of length for the tolerance */

#define SUM1(n, a, i) (n##_##a * k##a.v[i])
#define SUM2(n, a, b, i) (SUM1(n, a, i) + SUM1(n, b, i))
#define SUM3(n, a, b, c, i) (SUM2(n, a, b, i) + SUM1(n, c, i))
#define SUM4(n, a, b, c, d, i) (SUM3(n, a, b, c, i) + SUM1(n, d, i))
#define SUM5(n, a, b, c, d, e, i) (SUM4(n, a, b, c, d, i) + SUM1(n, e, i))
#define SUM6(n, a, b, c, d, e, f, i) (SUM5(n, a, b, c, d, e, i) + SUM1(n, f, i))
#define SUM7(n, a, b, c, d, e, f, g, i) (SUM6(n, a, b, c, d, e, f, i) + SUM1(n, g, i))
#define SUM8(n, a, b, c, d, e, f, g, h, i) (SUM7(n, a, b, c, d, e, f, g, i) + SUM1(n, h, i))
#define SUM9(n, a, b, c, d, e, f, g, h, j, i) (SUM8(n, a, b, c, d, e, f, g, h, i) + SUM1(n, j, i))
#define STAGE(number, sum) \
    rates_t k##number = rates(s->y[0] + h * (sum(0)), s->y[1] + h * (sum(1)), s->y[2] + h * (sum(2)), s->y[3] + h * (sum(3)), p)

/* A step of all lanes; a lane whose error is too large only changes its step size. Returns the mask of accepted lanes. */
INLINE mask advance(const lanes_t *s, const law_t *p, double tolerance, lanes_t *to)
{
    rates_t k1;
    memcpy(&k1, s->k, sizeof k1);
    vec h = s->h;
#define S2(i) SUM1(A2, 1, i)
#define S3(i) SUM2(A3, 1, 2, i)
#define S4(i) SUM2(A4, 1, 3, i)
#define S5(i) SUM3(A5, 1, 3, 4, i)
#define S6(i) SUM3(A6, 1, 4, 5, i)
#define S7(i) SUM4(A7, 1, 4, 5, 6, i)
#define S8(i) SUM5(A8, 1, 4, 5, 6, 7, i)
#define S9(i) SUM6(A9, 1, 4, 5, 6, 7, 8, i)
#define S10(i) SUM7(A10, 1, 4, 5, 6, 7, 8, 9, i)
#define S11(i) SUM8(A11, 1, 4, 5, 6, 7, 8, 9, 10, i)
#define S12(i) SUM9(A12, 1, 4, 5, 6, 7, 8, 9, 10, 11, i)
#define SB(i) SUM8(B, 1, 6, 7, 8, 9, 10, 11, 12, i)
#define S3RD(i) SUM8(E3, 1, 6, 7, 8, 9, 10, 11, 12, i)
#define S5TH(i) SUM8(E5, 1, 6, 7, 8, 9, 10, 11, 12, i)
    STAGE(2, S2);
    STAGE(3, S3);
    STAGE(4, S4);
    STAGE(5, S5);
    STAGE(6, S6);
    STAGE(7, S7);
    STAGE(8, S8);
    STAGE(9, S9);
    STAGE(10, S10);
    STAGE(11, S11);
    STAGE(12, S12);
    vec new[4], high = all(0.0), low = all(0.0);
    for (int i = 0; i < 4; i++) {
        new[i] = s->y[i] + h * SB(i);
        vec weight = 1.0 / (s->unit * (i < 2 ? 1.0 : p->rate) + larger(size(s->y[i]), size(new[i])));
        vec e5 = S5TH(i) * weight, e3 = S3RD(i) * weight;
        high += e5 * e5;
        low += e3 * e3;
    }
    vec t = s->t + h * SB(4);
    rates_t k = rates(new[0], new[1], new[2], new[3], p);
    vec error = h * high / (root((high + 0.01 * low) * 4.0 + 1e-300) * tolerance);
    mask good = error < 1.0;
    vec factor = smaller(larger(0.9 / root(root(root(larger(error, all(1e-30))))), all(0.2)), all(10.0));
    for (int i = 0; i < 4; i++)
        to->y[i] = pick(good, new[i], s->y[i]);
    for (int i = 0; i < 6; i++)
        to->k[i] = pick(good, k.v[i], s->k[i]);
    to->t = pick(good, t, s->t);
    to->unit = s->unit;
    to->h = h * pick(error < 1e300, factor, all(0.2));
    return good;
}

static cplx pull(cplx z, cplx w, const law_t *p)
{
    cplx v = w + I * p->omega * z;
    return -p->k2 * (z - p->offset) - (p->c + I * p->omega) * v;
}

static double time_to_rest(cplx z, cplx w, const law_t *p, double tolerance)
{
    double g = p->g, s = cabs(w);
    cplx a = pull(z, w, p);
    double excess = (g - cabs(a)) * (g + cabs(a));
    if (excess <= 0.0)
        return INFINITY;
    double left = (g * s + creal(conj(a) * w)) / excess;
    cplx v = w + I * p->omega * z, acceleration = a - g * w / s + I * p->omega * v;
    double change = cabs((p->c + I * p->omega) * acceleration + p->k2 * v) + cabs(a);
    return left * left * change < tolerance ? left : INFINITY;
}

static double release_delay(cplx z, const law_t *p)
{
    double constant = p->k2 * p->offset, g = p->g;
    cplx turning = pull(z, 0.0, p) - constant;
    double a = fabs(constant), q = cabs(turning);
    if (p->omega == 0.0 || a + q <= g * (1.0 + 1e-8))
        return INFINITY;
    double angle = carg(turning / constant) * copysign(1.0, p->omega);
    double limit = 2.0 * atan2(sqrt((a + q - g) * (a + q + g)), sqrt(fmax((g - a + q) * (g + a - q), 0.0)));
    double turn = fmod(-limit - angle, 2.0 * M_PI);
    if (turn < 0.0)
        turn += 2.0 * M_PI;
    if (2.0 * M_PI - turn < 1e-12)
        turn = 0.0;
    return turn / fabs(p->omega);
}

typedef struct { cplx z[MOST_TERMS + 2], v[MOST_TERMS + 2], a[MOST_TERMS + 2], w[MOST_TERMS + 2], n[MOST_TERMS + 2];
                 double theta[MOST_TERMS + 2], speed[MOST_TERMS + 2]; } series_t;

static double series(cplx z, const law_t *p, int first, int terms, double tolerance, double longest, series_t *s)
{
    cplx omega = I * p->omega, a = pull(z, 0.0, p);
    double strength = cabs(a);
    if (first == 1) {
        s->z[0] = z, s->v[0] = omega * z, s->a[0] = a, s->n[0] = a / strength;
        s->w[0] = 0.0, s->theta[0] = 0.0, s->speed[0] = 0.0, s->speed[1] = strength - p->g;
    }
    for (int k = first; k <= terms; k++) {
        s->z[k] = s->v[k - 1] / k;
        cplx total = 0.0;
        for (int j = 1; j <= k; j++)
            total += s->speed[j] * s->n[k - j];
        s->w[k] = total;
        s->v[k] = total + omega * s->z[k];
        s->a[k] = -(p->c + omega) * s->v[k] - p->k2 * s->z[k];
        total = 0.0;
        for (int j = 1; j < k; j++)
            total += j * s->theta[j] * s->n[k - j];
        s->n[k] = I * total / k;
        cplx b = 0.0;
        for (int j = 0; j <= k; j++)
            b += s->a[j] * conj(s->n[k - j]);
        double turning = 0.0;
        for (int j = 2; j <= k; j++)
            turning += s->speed[j] * (k + 1 - j) * s->theta[k + 1 - j];
        s->theta[k] = (cimag(b) - turning) / (strength + k * s->speed[1]);
        s->n[k] += I * s->theta[k] * s->n[0];
        s->speed[k + 1] = creal(b) / (k + 1);
    }
    double last = fmax(cabs(s->w[terms]), cabs(s->w[terms - 1]));
    return last > 0.0 ? fmin(longest, pow(tolerance / last, 1.0 / terms)) : longest;
}

static double speed_over_time(const series_t *s, int terms, double t)
{
    double total = s->speed[terms];
    for (int k = terms - 1; k >= 1; k--)
        total = total * t + s->speed[k];
    return total;
}

/* Slip from rest: changes z, sets w and returns the duration; w = 0 if the slip ended in rest. */
static double begin_slip(cplx *z, cplx *w, const law_t *p, double tolerance, double longest)
{
    series_t s;
    int terms = TERMS, risen = 0, ends = 0;
    double duration = series(*z, p, 1, terms, tolerance, longest, &s);
    if (p->g * duration > 100.0 * s.speed[2] * duration * duration && duration < longest) {
        duration = series(*z, p, TERMS + 1, MOST_TERMS, tolerance, longest, &s);
        terms = MOST_TERMS;
    }
    double rest = duration;
    for (int place = 1; place <= 8; place++) {
        double before = duration * (place - 1) / 8, t = duration * place / 8;
        if (speed_over_time(&s, terms, t) > 0.0)
            risen = 1;
        else if (risen || place == 8) {
            for (int i = 0; i < 60; i++) {
                double middle = 0.5 * (before + t);
                if (speed_over_time(&s, terms, middle) > 0.0)
                    before = middle;
                else
                    t = middle;
            }
            rest = t, ends = 1;
            break;
        }
    }
    cplx place = s.z[terms], slip = s.w[terms];
    for (int k = terms - 1; k >= 0; k--)
        place = place * rest + s.z[k], slip = slip * rest + s.w[k];
    *z = place, *w = ends ? 0.0 : slip;
    return rest;
}

static void put_slipping(lanes_t *s, int i, cplx z, cplx w, const law_t *p)
{
    rates_t k = rates(all(creal(z)), all(cimag(z)), all(creal(w)), all(cimag(w)), p);
    s->y[0][i] = creal(z), s->y[1][i] = cimag(z), s->y[2][i] = creal(w), s->y[3][i] = cimag(w);
    for (int j = 0; j < 6; j++)
        s->k[j][i] = k.v[j][0];
    s->h[i] = fmin(0.3 / p->rate, (cabs(w) + p->s0) / p->g);
}

/* Continue from rest until slip or the end; returns whether the end is reached. */
static int rest(lanes_t *s, int i, cplx z, double t, double end, const law_t *p, double tolerance)
{
    cplx w = 0.0;
    while (w == 0.0 && t < end) {
        if (cabs(pull(z, 0.0, p)) <= p->g) {
            double held = release_delay(z, p);
            z *= cexp(I * p->omega * fmin(held, end - t));
            t += held;
        }
        if (t < end)
            t += begin_slip(&z, &w, p, 0.1 * tolerance * s->unit[i] * p->rate, end - t);
    }
    put_slipping(s, i, z, w, p);
    s->t[i] = fmin(t, end);
    return t >= end;
}

/* Repeat the last step of a lane so that it ends at the time end. */
static void land(const lanes_t *before, lanes_t *after, int i, double end, const law_t *p)
{
    lanes_t one, to;
    for (int j = 0; j < 4; j++)
        one.y[j] = all(before->y[j][i]);
    for (int j = 0; j < 6; j++)
        one.k[j] = all(before->k[j][i]);
    double start = before->t[i], low = 0.0, high = before->h[i], h = high * (end - start) / (after->t[i] - start);
    one.t = all(0.0);
    one.unit = all(1.0);
    for (int n = 0; n < 100; n++) {
        one.h = all(h);
        advance(&one, p, 1e300, &to);
        double miss = end - start - to.t[0];
        if (miss > 0.0)
            low = h;
        else
            high = h;
        if (fabs(miss) <= 2e-16 * end || high - low <= 1e-15 * high)
            break;
        h += miss / to.k[4][0];
        if (!(low < h && h < high))
            h = 0.5 * (low + high);
    }
    for (int j = 0; j < 4; j++)
        after->y[j][i] = to.y[j][0];
}

static int load(lanes_t *s, int i, const double *start, double end, const law_t *p, double tolerance)
{
    cplx z = start[0] + I * start[1], w = start[2] + p->omega * start[1] + I * (start[3] - p->omega * start[0]);
    double place = fmax(hypot(start[0], start[1]), fabs(p->offset)), speed = hypot(start[2], start[3]);
    s->unit[i] = fmax(fmax(place, speed / p->rate), p->g / (p->rate * p->rate));
    s->t[i] = 0.0;
    if (cabs(w) <= 9e-16 * fabs(p->omega) * cabs(z))
        return rest(s, i, z, 0.0, end, p, tolerance);
    put_slipping(s, i, z, w, p);
    return 0;
}

static void store(const lanes_t *s, int i, double *state, const law_t *p)
{
    state[0] = s->y[0][i], state[1] = s->y[1][i];
    state[2] = s->y[2][i] - p->omega * state[1], state[3] = s->y[3][i] + p->omega * state[0];
}

/* pin: mass, stiffness, damping, friction force, disc speed, offset; starts and states: n rows of x, y, vx, vy. */
void run_pins(const double *pin, const double *starts, long first, long last, double end, double tolerance, double *states)
{
    double m = pin[0];
    double rate = fmax(sqrt(pin[1] / m), fabs(pin[4]));
    law_t law = {pin[1] / m, pin[2] / m, pin[3] / m, pin[4], pin[5], rate, 0.5 * pin[3] / m / rate};
    const law_t *p = &law;
    double slow = 10.0 * law.g * sqrt(tolerance) / rate;
    lanes_t now[HALVES], next[HALVES];
    long number[HALVES][WIDTH];
    int busy = 0;
    for (int half = 0; half < HALVES; half++)
        for (int i = 0; i < WIDTH; i++) {
            number[half][i] = -1;
            put_slipping(&next[half], i, 1.0, 1.0, p);
            next[half].t[i] = 0.0, next[half].unit[i] = 1.0;
            while (first < last) {
                int ended = load(&next[half], i, starts + 4 * first, end, p, tolerance);
                number[half][i] = first++;
                if (!ended)
                    break;
                store(&next[half], i, states + 4 * number[half][i], p);
                number[half][i] = -1;
            }
            busy += number[half][i] >= 0;
        }
    while (busy > 0) {
        mask good[HALVES];
        for (int half = 0; half < HALVES; half++) {
            now[half] = next[half];
            good[half] = advance(&now[half], p, tolerance, &next[half]);
        }
        for (int half = 0; half < HALVES; half++) {
            lanes_t *s = &next[half];
            vec slip = s->y[2] * s->y[2] + s->y[3] * s->y[3], growth = s->y[2] * s->k[2] + s->y[3] * s->k[3];
            mask due = good[half] & (s->t >= end), resting = good[half] & (slip < slow * slow) & (growth < 0.0);
            mask seen = due | resting;
            if (!any(seen))
                continue;
            for (int i = 0; i < WIDTH; i++) {
                if (number[half][i] < 0 || !seen[i])
                    continue;
                int ended = 0;
                if (due[i]) {
                    land(&now[half], s, i, end, p);
                    ended = 1;
                } else {
                    cplx z = s->y[0][i] + I * s->y[1][i], w = s->y[2][i] + I * s->y[3][i];
                    double left = time_to_rest(z, w, p, tolerance * s->unit[i] * rate);
                    if (left == INFINITY && cabs(w) < 1e-13)
                        left = 0.0;
                    if (s->t[i] + left < end) {
                        cplx middle = z + 0.5 * left * (0.75 * w + I * law.omega * z);
                        z += left * (0.5 * w + I * law.omega * middle);
                        ended = rest(s, i, z, s->t[i] + left, end, p, tolerance);
                    }
                }
                while (ended) {
                    store(s, i, states + 4 * number[half][i], p);
                    number[half][i] = -1;
                    busy--;
                    if (first == last) {
                        put_slipping(s, i, 1.0, 1.0, p);
                        s->t[i] = 0.0;
                        break;
                    }
                    ended = load(s, i, starts + 4 * first, end, p, tolerance);
                    number[half][i] = first++;
                    busy++;
                }
            }
        }
    }
}
