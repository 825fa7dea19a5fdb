/* The disc of disc.c in lanes, handwritten: the practical limit for reference_model.ensemble, at full length and without
   detecting end states.

   Method and arguments are those of disc.c; two vectors of eight lanes are refilled as trajectories finish. Friction of
   the ring takes as many means as the slowest lane may need. */

#include <math.h>

#include "lanes.h"
#include "stages.h"

enum { N = 6, ALL = 7, MEANS = 6, MOST_POINTS = 64 };

static const double ON_EDGE = 1e-4, AT_END = 1e-13, LEAST = 1e-300;
static const double REST = 1e-6; /* as in disc.c */

typedef struct { vec g, offset, s0, lag, curling, length, speed; } units_t; /* units of each trajectory, by its size */

typedef struct { vec q[ALL], k[ALL], h, usual, before, approach; units_t by; } lanes_t;

static double k2, beta, omega, eta, shaft;
static double around[2 * MOST_POINTS];

INLINE void ring(vec u, vec w, vec *by_slip, vec *by_rim)
{
    mask slides = u > w;
    vec large = larger(pick(slides, u, w), all(LEAST)), small = pick(slides, w, u), ratio = small / large;
    vec apart = larger((large - small) / large, all(1e-16)), m = ratio * ratio;
    vec b = root(apart * (1.0 + ratio)), a = 0.5 * (1.0 + b), rest = all(0.0);
    vec total = m / (8.0 * a * a);
    double weight = 1.0;
    b = root(b);
    for (int i = 0; i < MEANS; i++, weight *= 2.0) {
        vec c = a - b, next = 0.5 * (a + b);
        rest += weight * c * c;
        b = root(a * b);
        a = next;
    }
    total += pick(m > 1e-4, rest / larger(m, all(LEAST)), all(0.0));
    vec by_large = (1.0 - 0.5 * m * (1.0 + total)) / a, by_small = ratio * (0.5 - 0.5 * total) / a;
    *by_slip = pick(slides, by_large, by_small);
    *by_rim = pick(slides, by_small, by_large);
}

/* Cosine and sine by Taylor series about the nearest quarter turn, to rounding error. */
INLINE void turned(vec angle, vec *cosine, vec *sine)
{
    vec quarter;
    for (int i = 0; i < WIDTH; i++)
        quarter[i] = __builtin_nearbyint(angle[i] * M_2_PI);
    vec x = (angle - quarter * 1.57079632673412561417e+00) - quarter * 6.07710050650619224932e-11, z = x * x;
    vec s = x * (1.0 + z * (-1.0 / 6 + z * (1.0 / 120 + z * (-1.0 / 5040 + z * (1.0 / 362880
        + z * (-1.0 / 39916800 + z * (1.0 / 6227020800.0 - z * (1.0 / 1307674368000.0))))))));
    vec c = 1.0 + z * (-0.5 + z * (1.0 / 24 + z * (-1.0 / 720 + z * (1.0 / 40320
        + z * (-1.0 / 3628800 + z * (1.0 / 479001600 + z * (-1.0 / 87178291200.0 + z * (1.0 / 20922789888000.0))))))));
    mask n = __builtin_convertvector(quarter, mask), swap = (n & 1) != 0;
    vec one = pick(swap, s, c), other = pick(swap, c, s);
    *cosine = pick(((n + 1) & 2) != 0, -one, one);
    *sine = pick((n & 2) != 0, -other, other);
}

INLINE void rates(int points, const vec *q, const units_t *by, vec *k)
{
    vec x = q[0], y = q[1], ux = q[2], uy = q[3], r = q[4], fx, fy, fr, square = ux * ux + uy * uy;
    if (points == 0) {
        vec u = root(square), w = eta * size(r), by_slip, by_rim;
        ring(u, w, &by_slip, &by_rim);
        vec centre = by_slip / larger(u, all(LEAST)), turning = by_rim * (eta * eta) / larger(w, all(LEAST));
        fx = -centre * ux, fy = -centre * uy, fr = -turning * r;
    } else {
        vec c, s;
        turned(q[5], &c, &s);
        vec px = c * ux + s * uy, py = c * uy - s * ux, rim = eta * r;
        vec sx = all(0.0), sy = all(0.0), moment = all(0.0);
        for (int i = 0; i < points; i++) {
            double cx = around[2 * i], sn = around[2 * i + 1];
            vec vx = px - rim * sn, vy = py + rim * cx, inverse = 1.0 / larger(root(vx * vx + vy * vy), all(LEAST));
            vx *= inverse, vy *= inverse;
            sx += vx, sy += vy, moment += cx * vy - sn * vx;
        }
        double share = 1.0 / points;
        fx = (s * sy - c * sx) * share, fy = -(s * sx + c * sy) * share, fr = moment * (-eta * share);
    }
    vec slip = root(square + r * r), share = slip / (slip + by->s0);
    vec vx = ux - omega * y, vy = uy + omega * x;
    k[0] = share * vx;
    k[1] = share * vy;
    k[2] = share * (-k2 * (x - by->offset) - beta * vx + omega * vy + by->g * fx);
    k[3] = share * (-k2 * y - beta * vy - omega * vx + by->g * fy);
    k[4] = share * (-shaft * (r + by->lag) + by->g * fr);
    k[5] = share * (omega + by->curling * r);
    k[6] = share;
}

INLINE vec edge(int points, const vec *q, const vec *k, vec *rate)
{
    if (points) {
        *rate = all(0.0);
        return all(1.0);
    }
    vec u = root(q[2] * q[2] + q[3] * q[3]), w = size(q[4]);
    *rate = (q[2] * k[2] + q[3] * k[3]) / larger(u, all(LEAST)) - eta * q[4] * k[4] / larger(w, all(LEAST));
    return u - eta * w;
}

#define TRY(stage)                                                                        \
    for (int i = 0; i < N; i++) trial[i] = s->q[i] + h * STAGE_##stage;                   \
    rates(points, trial, &s->by, k[stage]);

/* One trial step of all lanes; a rejected lane only changes its step size. */
INLINE void advance(int points, lanes_t *s, double end, double tolerance)
{
    vec k[13][ALL], trial[ALL], h = s->h, high = all(0.0), low = all(0.0), leaving;
    for (int i = 0; i < ALL; i++)
        k[0][i] = s->k[i];
    TRY(1) TRY(2) TRY(3) TRY(4) TRY(5) TRY(6) TRY(7) TRY(8) TRY(9) TRY(10) TRY(11)
    for (int i = 0; i < ALL; i++)
        trial[i] = s->q[i] + h * MEAN;
    rates(points, trial, &s->by, k[12]);
    for (int i = 0; i < ALL; i++) {
        vec weight = i < 5 ? 1.0 / (1.0 + larger(size(s->q[i]), size(trial[i]))) : all(1.0);
        vec fifth = FIFTH * weight, third = THIRD * weight;
        high += fifth * fifth;
        low += third * third;
    }
    vec error = h * high / (root((high + 0.01 * low) * ALL + 1e-300) * tolerance);
    vec factor = 0.9 / root(root(root(larger(error, all(1e-30)))));
    vec next = h * smaller(larger(factor, all(0.2)), all(10.0));
    mask good = error < 1.0, beyond = good & (trial[6] > end + AT_END);

    vec after = edge(points, trial, k[12], &leaving), moved = after - s->before;
    mask across = good & ~beyond & (s->before * after < 0.0)
        & (smaller(size(s->before), size(after)) > ON_EDGE * size(moved));
    vec slope = s->approach * h, bend = moved - slope;
    vec width = root(larger(slope * slope - 4.0 * bend * s->before, all(0.0)));
    vec share = pick(s->approach * s->before < 0.0, size(2.0 * s->before) / (size(slope) + width + LEAST), all(0.5));
    mask taken = good & ~beyond & ~across;

    vec usual = larger(s->usual, h);
    for (int i = 0; i < ALL; i++) {
        s->q[i] = pick(taken, trial[i], s->q[i]);
        s->k[i] = pick(taken, k[12][i], s->k[i]);
    }
    vec on = smaller(larger(next, s->usual), (end - trial[6]) / larger(k[12][6], all(LEAST)));
    vec back = h * (end - s->q[6]) / (trial[6] - s->q[6]);
    vec to_edge = h * smaller(larger(share, all(0.01)), all(0.99));
    s->h = pick(taken, on, pick(across, to_edge, pick(beyond, back, next)));
    s->usual = pick(taken, all(0.0), pick(across, usual, s->usual));
    s->before = pick(taken, after, s->before);
    s->approach = pick(taken, leaving, s->approach);
}

/* Initialise a lane from six numbers. */
static void load(int points, lanes_t *s, int lane, const double *start, const double *disc, double kappa, double rate)
{
    double force = disc[4] / disc[0];
    double length = fmax(fmax(hypot(start[0], start[1]), fabs(disc[6])),
                         fmax(hypot(start[3], start[4]) / rate, force / (rate * rate)));
    double speed = length * rate, g = force / (speed * rate);
    double q[ALL] = {start[0] / length, start[1] / length, (start[3] + disc[5] * start[1]) / speed,
                     (start[4] - disc[5] * start[0]) / speed, kappa * (start[5] - disc[5]) / speed, start[2], 0.0};
    double by[] = {g, disc[6] / length, 0.5 * g, kappa * (disc[5] - disc[9]) / speed, length / kappa, length, speed};
    vec *units = (vec *)&s->by, state[ALL], k[ALL], approach;
    for (unsigned i = 0; i < sizeof by / sizeof *by; i++)
        units[i][lane] = by[i];
    for (int i = 0; i < ALL; i++)
        state[i] = s->q[i], state[i][lane] = q[i];
    rates(points, state, &s->by, k);
    vec before = edge(points, state, k, &approach);
    for (int i = 0; i < ALL; i++)
        s->q[i] = state[i], s->k[i][lane] = k[i][lane];
    s->before[lane] = before[lane], s->approach[lane] = approach[lane];
    s->h[lane] = 0.1, s->usual[lane] = 0.0;
}

static void store(const lanes_t *s, int lane, double rate, double end, double *state)
{
    double length = s->by.length[lane], speed = s->by.speed[lane];
    state[0] = s->q[6][lane] < end - AT_END ? NAN : s->q[0][lane] * length;
    state[1] = s->q[1][lane] * length, state[2] = s->q[5][lane];
    state[3] = (s->q[2][lane] - omega * s->q[1][lane]) * speed, state[4] = (s->q[3][lane] + omega * s->q[0][lane]) * speed;
    state[5] = (omega + s->by.curling[lane] * s->q[4][lane]) * rate;
}

INLINE long run(int points, const double *disc, const double *starts, long n, double end, double tolerance, double kappa,
                double rate, double *states)
{
    lanes_t lanes[HALVES];
    long number[HALVES][WIDTH], first = 0, busy = 0, steps = 0;
    for (int half = 0; half < HALVES; half++)
        for (int i = 0; i < WIDTH; i++) { /* idle lanes repeat the first start */
            long mine = first < n ? first++ : 0;
            number[half][i] = mine || (!half && !i) ? mine : -1;
            busy += number[half][i] >= 0;
            for (int j = 0; j < ALL; j++)
                lanes[half].q[j][i] = 0.0;
            load(points, &lanes[half], i, starts + 6 * mine, disc, kappa, rate);
        }
    while (busy > 0)
        for (int half = 0; half < HALVES; half++) {
            lanes_t *s = &lanes[half];
            steps += half ? 0 : busy;
            advance(points, s, end, tolerance);
            mask due = s->q[6] >= end - AT_END;
            if (points)
                due |= (s->h <= REST) & (end - s->q[6] >= 1e-3);
            if (!any(due))
                continue;
            for (int i = 0; i < WIDTH; i++) {
                if (!due[i] || number[half][i] < 0)
                    continue;
                store(s, i, rate, end, states + 6 * number[half][i]);
                number[half][i] = first < n ? first++ : -1;
                busy -= number[half][i] < 0;
                if (number[half][i] >= 0)
                    load(points, s, i, starts + 6 * number[half][i], disc, kappa, rate);
            }
        }
    return steps;
}

long run_discs_in_lanes(int points, const double *disc, const double *starts, long n, double duration, double tolerance,
                        double *states)
{
    for (int i = 0; i < points; i++) {
        around[2 * i] = cos(2.0 * M_PI * i / points);
        around[2 * i + 1] = sin(2.0 * M_PI * i / points);
    }
    double kappa = sqrt(disc[1] / disc[0]), rate = fmax(sqrt(disc[2] / disc[0]), fabs(disc[5]));
    k2 = disc[2] / disc[0] / (rate * rate), beta = disc[3] / disc[0] / rate, omega = disc[5] / rate;
    eta = disc[7] / kappa, shaft = disc[8] / disc[1] / rate;
    double end = duration * rate;
    if (points == 0)
        return run(0, disc, starts, n, end, tolerance, kappa, rate, states);
    if (points == 6)
        return run(6, disc, starts, n, end, tolerance, kappa, rate, states);
    return run(points, disc, starts, n, end, tolerance, kappa, rate, states);
}
