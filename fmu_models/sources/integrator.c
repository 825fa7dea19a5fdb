/* Dormand and Prince's pair of orders 5 and 4 with error control. Its continuous extension of order 4 locates the
   events of exact Coulomb friction (Hairer, Norsett, Wanner, Solving ODE I, II.5 and II.6). Creep is stiff and is
   integrated by Radau's method. */
#include "step.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define MOST_STEPS 20000000L /* largest number of steps between two communication points */
#define SAMPLES 8 /* intervals per step that are searched for an event */
#define HALVINGS 40 /* bisections of a step in which points come to rest or are released */
#define LET_GO 2.0  /* slip speed over epsilon that counts as release; integration errors reached 1.1 */
#define AT_LIMIT 3.25 /* h times the largest eigenvalue near the explicit stability limit (IV.2 of II) */
#define IN_A_ROW 15   /* number of such steps before the implicit method takes over */

static const double A[6][6] = {
    {1.0 / 5},
    {3.0 / 40, 9.0 / 40},
    {44.0 / 45, -56.0 / 15, 32.0 / 9},
    {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
    {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
    {35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84},
};
static const double C[6] = {1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1.0, 1.0};
static const double E[7] = {71.0 / 57600,      0.0,          -71.0 / 16695, 71.0 / 1920,
                            -17253.0 / 339200, 22.0 / 525,   -1.0 / 40};

/* Counts explicit steps at the stability limit; last is the state of the last but one stage. */
static void watch(State *s, const Step *one, const double last[N]) {
    double slopes = 0.0, ways = 0.0;
    for (int i = 0; i < N; i++) {
        double size = allowed(s, one, i);
        slopes = fmax(slopes, fabs(one->k[6][i] - one->k[5][i]) / size);
        ways = fmax(ways, fabs(one->end[i] - last[i]) / size);
    }
    if (one->h * slopes > AT_LIMIT * ways) s->held_up++;
    else if (s->held_up > 0) s->held_up--;
}

/* Fills k[1..6] and the end of a step from its t, h, y and k[0]; returns its error over the allowed error. */
static double explicit_attempt(State *s, Step *one) {
    double worst = 0.0, last[N];
    if (model_carried(s, one->t + one->h, one->end)) return 0.0;
    for (int stage = 0; stage < 6; stage++) {
        memcpy(last, one->end, sizeof last);
        for (int i = 0; i < N; i++) {
            double sum = 0.0;
            for (int j = 0; j <= stage; j++) sum += A[stage][j] * one->k[j][i];
            one->end[i] = one->y[i] + one->h * sum;
        }
        rates(s, one->t + C[stage] * one->h, one->end, one->k[stage + 1]);
    }
    for (int i = 0; i < N; i++) {
        double error = 0.0;
        for (int j = 0; j < 7; j++) error += E[j] * one->k[j][i];
        error = fabs(one->h * error) / allowed(s, one, i);
        if (!(error <= worst)) worst = error; /* also NaN */
    }
    if (worst <= 1.0 && !s->exact) watch(s, one, last);
    return worst;
}

static double attempt(State *s, Step *one) {
    double J[N][N];
    if (s->held_up < IN_A_ROW) return explicit_attempt(s, one);
    memcpy(one->end, one->y, sizeof one->end);
    if (is_stiff(s, one, J)) return implicit_attempt(s, one, J);
    s->held_up = 0;
    return explicit_attempt(s, one);
}

#ifdef V_indicator
static const double D[7] = {-12715105075.0 / 11282082432, 0.0, 87487479700.0 / 32700410799,
                            -10690763975.0 / 1880347072,  701980252875.0 / 199316789632,
                            -1453857185.0 / 822651844,    69997945.0 / 29380423};

/* State at the fraction x of a step. */
static void within(const State *s, const Step *one, double x, double y[N]) {
    if (model_carried(s, one->t + x * one->h, y)) return;
    for (int i = 0; i < N; i++) {
        double rise = one->end[i] - one->y[i], first = one->h * one->k[0][i] - rise, last = 0.0;
        for (int j = 0; j < 7; j++) last += D[j] * one->k[j][i];
        y[i] = one->y[i] + x * (rise + (1.0 - x) * (first + x * (rise - one->h * one->k[6][i] - first +
                                                                 (1.0 - x) * one->h * last)));
    }
}

static double indicator(State *s, const Step *one, double x) {
    double y[N], f[N];
    within(s, one, x, y);
    rates(s, one->t + x * one->h, y, f);
    return s->v[V_indicator];
}

/* Returns whether the indicator changes sign in a step, and ends the step just after the change. */
static int event(State *s, Step *one) {
    double before;
    if (!s->exact) return 0;
    before = indicator(s, one, 0.0);
    for (int i = 1; i <= SAMPLES; i++) {
        double low = (i - 1.0) / SAMPLES, high = i / (double)SAMPLES;
        if ((indicator(s, one, high) > 0.0) == (before > 0.0)) continue;
        for (int turn = 0; turn < 60; turn++) {
            double middle = 0.5 * (low + high);
            if ((indicator(s, one, middle) > 0.0) == (before > 0.0)) low = middle;
            else high = middle;
        }
        within(s, one, high, one->end);
        one->h *= high;
        return 1;
    }
    return 0;
}
#else
static int event(State *s, Step *one) {
    (void)s, (void)one;
    return 0;
}
#endif

#ifdef V_resting_points
/* Locates by bisection, with repeated steps, when the number of resting points changes. */
static void locate(State *s, const Step *one, int then) {
    State trial = *s;
    Step part = *one;
    double before = 0.0, behind = one->h;
    memcpy(s->left, one->end, sizeof s->left);
    for (int halving = 0; halving < HALVINGS; halving++) {
        part.h = 0.5 * (before + behind);
        trial.held_up = s->held_up; /* the same method */
        if (!(attempt(&trial, &part) < HUGE_VAL)) break;
        for (int i = 0; i < N; i++) trial.v[STATES[i]] = part.end[i];
        if (model_resting(&trial, 1.0) == then) {
            before = part.h;
        } else {
            behind = part.h;
            memcpy(s->left, part.end, sizeof s->left);
        }
    }
    s->left_time = one->t + behind;
}

/* Records when points come to rest or are released in a step. A release is recorded at epsilon, but only once the slip
   reaches LET_GO times epsilon, because integration errors can cross epsilon back and forth. */
static void note_rests(State *s, const Step *one) {
    int then = (int)s->v[V_resting_points], least, most;
    for (int i = 0; i < N; i++) s->v[STATES[i]] = one->end[i];
    least = model_resting(s, 1.0);
    most = model_resting(s, LET_GO);
    if (least > then || (least < then && !s->leaves)) locate(s, one, then);
    s->leaves = least < then;
    if (least == then || (s->leaves && most >= then)) return;
    s->leaves = 0;
    s->v[V_resting_points] = least > then ? least : most;
    s->v[V_rest_count] += 1.0;
    s->v[V_rest_time] = s->left_time;
    for (int i = 0; i < N; i++) s->v[V_rest_x + i] = s->left[i];
}
#else
static void note_rests(State *s, const Step *one) {
    (void)s, (void)one;
}
#endif

static double first_step(const State *s, const double y[N], const double f[N], double longest) {
    double h = longest;
    for (int i = 0; i < N; i++)
        if (f[i] != 0.0) h = fmin(h, 0.01 * (s->nominal[i] + fabs(y[i])) / fabs(f[i]));
    return h;
}

int unit_advance(Unit *unit, double until) {
    State *s = &unit->state;
    Step one;
    char sentence[INTERNAL_DIGITS];
    long tried = 0;
    double begin = s->v[V_time], least = 1e-15 * (1.0 + fabs(begin) + fabs(until));
    if (!(begin <= until && isfinite(until))) {
        snprintf(sentence, sizeof sentence, "step from t = %g s to %g s: it must be finite and must not go back", begin,
                 until);
        unit->say(unit, 1, sentence);
        return 1;
    }
    one.t = begin;
    for (int i = 0; i < N; i++) one.y[i] = s->v[STATES[i]];
    rates(s, one.t, one.y, one.k[0]);
    one.slip = s->slowest;
    if (!(s->step > 0.0)) s->step = first_step(s, one.y, one.k[0], until - begin);
    while (until - one.t > least) {
        double error, factor, left = until - one.t;
        int last, happens;
        one.h = fmin(s->step, s->longest);
        last = one.h >= 0.999999 * left;
        if (last) one.h = left;
        if (tried++ == MOST_STEPS) {
            snprintf(sentence, sizeof sentence, "at t = %.9g s the limit of %ld steps was reached, the last of them %.3g s long",
                     one.t, tried - 1, one.h);
            unit->say(unit, 1, sentence);
            return 1;
        }
        error = attempt(s, &one);
        factor = error > 0.0 ? 0.9 * pow(error, -0.2) : error == 0.0 ? 5.0 : 0.2;
        if (!(error <= 1.0)) { /* also NaN */
            s->step = one.h * (factor > 0.1 ? fmin(factor, 0.9) : 0.1);
            if (s->step < least) {
                snprintf(sentence, sizeof sentence, "at t = %.9g s the steps became too short: %.3g s", one.t,
                         s->step);
                unit->say(unit, 1, sentence);
                return 1;
            }
            continue;
        }
        if (!last || factor < 1.0) s->step = one.h * fmin(fmax(factor, 0.2), 5.0);
        else s->step = fmax(s->step, one.h * fmin(factor, 5.0));
        note_rests(s, &one);
        happens = event(s, &one);
        one.t = last && !happens ? until : one.t + one.h;
        memcpy(one.y, one.end, sizeof one.y);
        s->v[V_time] = one.t;
        for (int i = 0; i < N; i++) s->v[STATES[i]] = one.y[i];
        if (happens && model_change(s)) /* the states jump to those of stick or release */
            for (int i = 0; i < N; i++) one.y[i] = s->v[STATES[i]];
        rates(s, one.t, one.y, one.k[0]);
        one.slip = s->slowest;
        if (unit->between && unit->between(unit, one.t) && until - one.t > least) return 2;
    }
    s->v[V_time] = until;
    s->stale = 1;
    return 0;
}
