/* Dry friction of a pin, a ring or an annulus: gradient of a slip potential, regularised near rest. */
#ifndef CONTACT_H
#define CONTACT_H

typedef struct {
    double inner, outer; /* radii in m: alike for a ring, both 0 for a pin */
    int wear;            /* pressure over an annulus: as linings wear, or uniform */
    double friction;     /* mu N of all plates while it slides, in N */
    double static_ratio; /* of static to sliding friction */
    double epsilon;      /* mean slip speed in m/s below which the contact is viscous */
} Contact;

/* dP/dU and dP/dW of a ring whose centre slips with U and whose rim turns with W, both >= 0, not both 0. */
void ring_slopes(double U, double W, double slope[2]);

/* d2P/dU2, d2P/dUdW, d2P/dW2. */
void ring_curvatures(double U, double W, double curvature[3]);

/* The mean slip speed P in m/s; its slopes by U and by |S| (m) unless both are 0. */
double slip_potential(const Contact *contact, double U, double S, double slope[2]);

/* Fx, Fy in N and M in N m on the disc, whose centre slips with slip[0..1] in m/s and which turns with slip[2]
   in rad/s over what it touches. Returns P. */
double friction(const Contact *contact, const double slip[3], double force[3]);

/* The derivative of that along the direction d of the slip; at rest that to the side of d. Returns that of P.
   d_friction is that of mu N. */
double friction_tangent(const Contact *contact, const double slip[3], const double d[3], double d_friction,
                        double d_force[3]);

/* The least mu N in N with which the contact at rest holds a force of this size (N) and a moment (N m), and its
   derivatives by both. */
double friction_needed(const Contact *contact, double force, double moment, double by[2]);

#endif
