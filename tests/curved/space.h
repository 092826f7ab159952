/* Vectors and turns of the checks of curved prints, which share nothing with the engine. */
#ifndef TESTS_CURVED_SPACE_H
#define TESTS_CURVED_SPACE_H

#include <math.h>

#define PI 3.14159265358979323846

typedef struct vec {
    double x, y, z;
} vec;

typedef struct turn {
    vec row[3];
} turn;

static inline vec plus(vec a, vec b) {
    return (vec){a.x + b.x, a.y + b.y, a.z + b.z};
}
static inline vec minus(vec a, vec b) {
    return (vec){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline vec times(vec a, double s) {
    return (vec){a.x * s, a.y * s, a.z * s};
}
static inline double dot(vec a, vec b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline double length(vec a) {
    return sqrt(dot(a, a));
}
static inline vec unit(vec a) {
    return times(a, 1 / length(a));
}
static inline vec mix(vec a, vec b, double t) {
    return plus(times(a, 1 - t), times(b, t));
}
static inline vec cross(vec a, vec b) {
    return (vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline vec turned(turn r, vec p) {
    return (vec){dot(r.row[0], p), dot(r.row[1], p), dot(r.row[2], p)};
}
static inline vec turned_back(turn r, vec p) {
    return plus(plus(times(r.row[0], p.x), times(r.row[1], p.y)), times(r.row[2], p.z));
}

/* Right-handed, by degrees around X, Y or Z (axis 0, 1, 2). */
static inline turn turn_about(int axis, double degrees) {
    double c = cos(degrees * PI / 180), s = sin(degrees * PI / 180);
    if (axis == 0)
        return (turn){{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
    if (axis == 1)
        return (turn){{{c, 0, s}, {0, 1, 0}, {-s, 0, c}}};
    return (turn){{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
}

/* First b, then a. */
static inline turn turn_after(turn a, turn b) {
    turn r;
    for (int i = 0; i < 3; i++)
        r.row[i] = turned_back(b, a.row[i]);
    return r;
}

#endif
