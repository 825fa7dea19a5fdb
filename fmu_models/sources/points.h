/* The slip of single points of a contact. */
#ifndef POINTS_H
#define POINTS_H
#include "contact.h"

/* Mean over the points of slip / max(|slip|, epsilon): along x, y, and its moment about the centre in m. Friction is
   -mu N times this mean. Returns the mean speed and the slowest point's, in m/s. */
double points_slip(const Contact *contact, const double slip[3], double mean[3], double *slowest);

/* Number of points slower than epsilon: 0, 1, or all, because a rigid body rests if two of its points do. */
int points_at_rest(const Contact *contact, const double slip[3]);

/* Derivative of points_slip along the change d of the slip and d_angle of the angle. Returns that of the mean speed. */
double points_slip_tangent(const Contact *contact, const double slip[3], const double d[3], double d_angle,
                           double d_mean[3]);

#endif
