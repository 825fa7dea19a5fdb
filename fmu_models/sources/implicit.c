/* Radau IIA of order 5, for creep: collocation by Newton's iteration with the closed-form Jacobian, and an error
   estimate of order 3 (Hairer, Wanner, Solving ODE II, IV.8). */
#include "step.h"
#include <math.h>
#include <string.h>

#define MOST_TURNS 10
#define CONVERGED 1e-2 /* error of Newton's iteration over the allowed error */
#define SQRT6 2.44948974278317809820
#define REAL 3.63783425274449573220 /* the real eigenvalue of the inverse of A */

static const double A[3][3] = {
    {(88.0 - 7.0 * SQRT6) / 360.0, (296.0 - 169.0 * SQRT6) / 1800.0, (-2.0 + 3.0 * SQRT6) / 225.0},
    {(296.0 + 169.0 * SQRT6) / 1800.0, (88.0 + 7.0 * SQRT6) / 360.0, (-2.0 - 3.0 * SQRT6) / 225.0},
    {(16.0 - SQRT6) / 36.0, (16.0 + SQRT6) / 36.0, 1.0 / 9.0},
};
static const double C[3] = {(4.0 - SQRT6) / 10.0, (4.0 + SQRT6) / 10.0, 1.0};
static const double E[3] = {-(13.0 + 7.0 * SQRT6) / 3.0, (-13.0 + 7.0 * SQRT6) / 3.0, -1.0 / 3.0};

/* LU factors of the n by n matrix a, in place; returns 1 if it is singular. */
static int factorise(int n, double a[], int row[]) {
    for (int j = 0; j < n; j++) {
        row[j] = j;
        for (int i = j + 1; i < n; i++)
            if (fabs(a[i * n + j]) > fabs(a[row[j] * n + j])) row[j] = i;
        if (!(fabs(a[row[j] * n + j]) > 0.0)) return 1;
        for (int k = 0; k < n; k++) {
            double swapped = a[j * n + k];
            a[j * n + k] = a[row[j] * n + k];
            a[row[j] * n + k] = swapped;
        }
        for (int i = j + 1; i < n; i++) {
            double factor = a[i * n + j] /= a[j * n + j];
            for (int k = j + 1; k < n; k++) a[i * n + k] -= factor * a[j * n + k];
        }
    }
    return 0;
}

static void solve(int n, const double a[], const int row[], double b[]) {
    for (int i = 0; i < n; i++) {
        double swapped = b[i];
        b[i] = b[row[i]];
        b[row[i]] = swapped;
    }
    for (int i = 0; i < n; i++)
        for (int k = 0; k < i; k++) b[i] -= a[i * n + k] * b[k];
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++) b[i] -= a[i * n + k] * b[k];
        b[i] /= a[i * n + i];
    }
}

int is_stiff(State *s, const Step *one, double J[N][N]) {
    double unused[N], worst = 0.0;
    rates(s, one->t, one->y, unused);
    for (int j = 0; j < N; j++) {
        double d[N_VARIABLES] = {0.0};
        d[STATES[j]] = 1.0;
        model_tangent(s, d);
        for (int i = 0; i < N; i++) J[i][j] = d[DERIVATIVES[i]];
    }
    for (int i = 0; i < N; i++) {
        double sum = 0.0;
        for (int j = 0; j < N; j++) sum += fabs(J[i][j]) * allowed(s, one, j);
        worst = fmax(worst, sum / allowed(s, one, i));
    }
    return one->h * worst > 1.0;
}

/* Newton's iteration for the increments z of the three stages; returns 1 if it fails. */
static int collocate(State *s, const Step *one, double J[N][N], double z[3][N]) {
    double matrix[9 * N * N], before = 0.0;
    int row[3 * N];
    for (int p = 0; p < 3 * N; p++)
        for (int q = 0; q < 3 * N; q++)
            matrix[p * 3 * N + q] = (p == q) - one->h * A[p / N][q / N] * J[p % N][q % N];
    if (factorise(3 * N, matrix, row)) return 1;
    memset(z, 0, 3 * sizeof z[0]);
    for (int turn = 0; turn < MOST_TURNS; turn++) {
        double f[3][N], change[3 * N], size = 0.0, rate;
        for (int p = 0; p < 3; p++) {
            double y[N];
            for (int i = 0; i < N; i++) y[i] = one->y[i] + z[p][i];
            rates(s, one->t + C[p] * one->h, y, f[p]);
        }
        for (int p = 0; p < 3 * N; p++) {
            change[p] = -z[p / N][p % N];
            for (int q = 0; q < 3; q++) change[p] += one->h * A[p / N][q] * f[q][p % N];
        }
        solve(3 * N, matrix, row, change);
        for (int p = 0; p < 3 * N; p++) {
            z[p / N][p % N] += change[p];
            size = fmax(size, fabs(change[p]) / allowed(s, one, p % N));
        }
        rate = turn > 0 && before > 0.0 ? size / before : 0.0;
        if (!(size < HUGE_VAL) || rate >= 0.99) return 1;
        if (size <= 1e-3 * CONVERGED || (turn > 0 && size * rate / (1.0 - rate) <= CONVERGED)) return 0;
        before = size;
    }
    return 1;
}

double implicit_attempt(State *s, Step *one, double J[N][N]) {
    double z[3][N], matrix[N * N], slope[N], f[N], error[N], worst = 0.0;
    int row[N];
    if (collocate(s, one, J, z)) return NAN;
    for (int p = 0; p < N * N; p++) matrix[p] = (p / N == p % N) * REAL / one->h - J[p / N][p % N];
    if (factorise(N, matrix, row)) return NAN;
    memcpy(f, one->k[0], sizeof f);
    for (int i = 0; i < N; i++) {
        one->end[i] = one->y[i] + z[2][i];
        slope[i] = (E[0] * z[0][i] + E[1] * z[1][i] + E[2] * z[2][i]) / one->h;
    }
    for (int turn = 0; turn < 2; turn++) { /* the second pass damps the stiff components of the estimate */
        worst = 0.0;
        for (int i = 0; i < N; i++) error[i] = f[i] + slope[i];
        solve(N, matrix, row, error);
        for (int i = 0; i < N; i++) worst = fmax(worst, fabs(error[i]) / allowed(s, one, i));
        if (worst <= 1.0 || turn) break;
        for (int i = 0; i < N; i++) error[i] += one->y[i];
        rates(s, one->t, error, f);
    }
    return pow(worst, 1.25);
}
