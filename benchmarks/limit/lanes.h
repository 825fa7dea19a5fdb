/* Vectors with one number of each of eight trajectories; alternating between two vectors keeps the processor busy. */
#ifndef LANES_H
#define LANES_H

#define HALVES 2
#define WIDTH 8
#define INLINE static inline __attribute__((always_inline))

typedef double vec __attribute__((vector_size(64)));
typedef long long mask __attribute__((vector_size(64)));

INLINE vec all(double x) { return (vec){x, x, x, x, x, x, x, x}; }
INLINE vec pick(mask m, vec a, vec b) { return (vec)((m & (mask)a) | (~m & (mask)b)); }
INLINE vec larger(vec a, vec b) { return pick(a > b, a, b); }
INLINE vec smaller(vec a, vec b) { return pick(a < b, a, b); }
INLINE vec size(vec a) { return larger(a, -a); }
INLINE vec root(vec a)
{
    vec r;
    for (int i = 0; i < WIDTH; i++)
        r[i] = __builtin_sqrt(a[i]);
    return r;
}

INLINE int any(mask m)
{
    long long found = 0;
    for (int i = 0; i < WIDTH; i++)
        found |= m[i];
    return found != 0;
}

#endif
