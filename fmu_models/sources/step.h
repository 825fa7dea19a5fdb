/* A step of the integrator, by either of its methods. */
#ifndef STEP_H
#define STEP_H
#include "unit.h"

#define N (N_STATES)

typedef struct {
    double t, h, y[N], k[7][N], end[N], slip; /* the slowest of the contact where the step begins */
} Step;

/* Rates f of the states at a time in s and y. */
void rates(State *state, double t, const double y[N], double f[N]);

/* By how much a step may miss a state. */
double allowed(const State *state, const Step *step, int i);

/* Whether the Jacobian J where a step begins is so large that an explicit step is held up by it. */
int is_stiff(State *state, const Step *step, double J[N][N]);

/* Fills the end of a step of which t, h, y, k[0] and J are there; returns its error over what is allowed, to the power
   with which that of an explicit step goes, or no number if there is no answer. */
double implicit_attempt(State *state, Step *step, double J[N][N]);

#endif
