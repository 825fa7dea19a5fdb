/* A step of the integrator, by either of its methods. */
#ifndef STEP_H
#define STEP_H
#include "unit.h"

#define N (N_STATES)

typedef struct {
    double t, h, y[N], k[7][N], end[N], slip; /* slip: the slowest slip speed at the start of the step */
} Step;

/* Rates f of the states y at the time t in s. */
void rates(State *state, double t, const double y[N], double f[N]);

/* Allowed error of state i in a step. */
double allowed(const State *state, const Step *step, int i);

/* Computes the Jacobian J at the start of a step; returns whether it limits an explicit step. */
int is_stiff(State *state, const Step *step, double J[N][N]);

/* Fills the end of a step from its t, h, y, k[0] and J. Returns its error over the allowed error, raised to the power that
   makes it scale with h as in an explicit step, or NaN if the step fails. */
double implicit_attempt(State *state, Step *step, double J[N][N]);

#endif
