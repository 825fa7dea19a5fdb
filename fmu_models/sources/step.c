/* What both methods of the integrator share: the rates, and the allowed error of a step. */
#include "step.h"
#include <math.h>

#define DIRECTION 1e-3 /* largest velocity error over slip, which keeps the direction of friction accurate */

void rates(State *s, double t, const double y[N], double f[N]) {
    s->v[V_time] = t;
    for (int i = 0; i < N; i++) s->v[STATES[i]] = y[i];
    model_evaluate(s);
    for (int i = 0; i < N; i++) f[i] = s->v[DERIVATIVES[i]];
}

double allowed(const State *s, const Step *one, int i) {
    double size = s->tolerance * (s->nominal[i] + fmax(fabs(one->y[i]), fabs(one->end[i])));
    return STATE_KINDS[i] == 'v' ? fmin(size, DIRECTION * fmax(one->slip, s->epsilon)) : size;
}
