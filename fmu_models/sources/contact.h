/* Dry friction of a pin, points, a ring or an annulus: gradient of a slip potential, regularised near rest. */
#ifndef CONTACT_H
#define CONTACT_H

typedef struct {
    double inner, outer; /* radii in m: alike for a ring, both 0 for a pin */
    int points;          /* single ones on the outer radius, or 0 for all of it */
    double angle;        /* of the first of them in rad */
    int wear;            /* pressure over an annulus: as linings wear, or uniform, times a parabola */
    double pressure[3];  /* which has these values at the inner, the mean and the outer radius */
    double friction;     /* mu N of all plates while it slides, in N */
    double static_ratio; /* of static to sliding friction */
    double epsilon;      /* slip speed in m/s below which the contact is viscous: its mean, or that of each point */
} Contact;

/* dP/dU and dP/dW of a ring whose centre slips with U and whose rim turns with W, both >= 0, not both 0. */
void ring_slopes(double U, double W, double slope[2]);

/* d2P/dU2, d2P/dUdW, d2P/dW2. */
void ring_curvatures(double U, double W, double curvature[3]);

/* The mean slip speed P in m/s of a pin, a ring or an annulus; its slopes by U and by |S| (m) unless both are 0. */
double slip_potential(const Contact *contact, double U, double S, double slope[2]);

/* Fx, Fy in N and M in N m on the disc, whose centre slips with slip[0..1] in m/s and which turns with slip[2]
   in rad/s over what it touches. Returns P, and the slip speed of the slowest point if there are points, else P. */
double friction(const Contact *contact, const double slip[3], double force[3], double *slowest);

/* The derivative of that along the direction d of the slip; at rest that to the side of d. Returns that of P.
   d_friction is that of mu N, d_angle that of the angle. */
double friction_tangent(const Contact *contact, const double slip[3], const double d[3], double d_friction,
                        double d_angle, double d_force[3]);

/* The least mu N in N with which a pin, a ring or an annulus at rest holds a force of this size (N) and a moment (N m), and its
   derivatives by both. */
double friction_needed(const Contact *contact, double force, double moment, double by[2]);

#endif
