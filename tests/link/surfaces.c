#include "link/surfaces.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

uint32_t next_random(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*state >> 33);
}

static void begin(polyhedron *s) {
    s->faces = (iso_faces){0};
    s->faces.first = s->first;
    s->faces.vertex = s->vertex;
    s->faces.position = s->position;
    s->faces.dimension = 3;
    s->first[0] = 0;
}

static void add_vertex(polyhedron *s, double x, double y, double z) {
    double *at = s->position + 3 * s->faces.vertex_count++;
    at[0] = x, at[1] = y, at[2] = z;
}

static void add_face(polyhedron *s, int count, const int32_t *vertex) {
    int32_t at = s->first[s->faces.face_count];
    memcpy(s->vertex + at, vertex, (size_t)count * sizeof *vertex);
    s->first[++s->faces.face_count] = at + count;
}

void drop_face(polyhedron *s, int32_t face) {
    int32_t at = s->first[face], count = s->first[face + 1] - at;
    int32_t total = s->first[s->faces.face_count];
    memmove(s->vertex + at, s->vertex + at + count,
            (size_t)(total - at - count) * sizeof *s->vertex);
    for (int32_t i = face; i < s->faces.face_count; i++)
        s->first[i] = s->first[i + 1] - count;
    s->faces.face_count--;
}

void make_tetrahedron(polyhedron *s) {
    static const int32_t face[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    begin(s);
    add_vertex(s, 0, 0, 0);
    add_vertex(s, 1, 0, 0);
    add_vertex(s, 0, 1, 0);
    add_vertex(s, 0, 0, 1);
    for (int i = 0; i < 4; i++)
        add_face(s, 3, face[i]);
}

static double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The five vertices furthest along the face's normal, by their angle around it. */
static void add_dodecahedron_face(polyhedron *s, const double *normal) {
    int32_t corner[5];
    double angle[5], side[3] = {normal[1], normal[2], normal[0]}, most = 0;
    double square = dot(normal, normal), along = dot(side, normal);
    for (int k = 0; k < 3; k++)
        side[k] -= normal[k] * along / square;
    double other[3] = {normal[1] * side[2] - normal[2] * side[1],
                       normal[2] * side[0] - normal[0] * side[2],
                       normal[0] * side[1] - normal[1] * side[0]};
    double scale = sqrt(square);
    int count = 0;
    for (int32_t v = 0; v < 20; v++)
        most = fmax(most, dot(normal, s->position + 3 * v));
    for (int32_t v = 0; v < 20; v++) {
        const double *at = s->position + 3 * v;
        if (dot(normal, at) < most - 1e-9)
            continue;
        double turn = atan2(dot(other, at) / scale, dot(side, at));
        int i = count++;
        for (; i > 0 && angle[i - 1] > turn; i--)
            angle[i] = angle[i - 1], corner[i] = corner[i - 1];
        angle[i] = turn, corner[i] = v;
    }
    add_face(s, 5, corner);
}

void make_dodecahedron(polyhedron *s) {
    double p = (1 + sqrt(5)) / 2;
    begin(s);
    for (int i = 0; i < 8; i++)
        add_vertex(s, i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    for (int i = 0; i < 4; i++) {
        double a = (i & 1 ? 1 : -1) / p, b = (i & 2 ? 1 : -1) * p;
        add_vertex(s, 0, a, b);
        add_vertex(s, a, b, 0);
        add_vertex(s, b, 0, a);
    }
    for (int i = 0; i < 4; i++) {
        double a = i & 1 ? 1 : -1, b = (i & 2 ? 1 : -1) * p;
        double normal[3][3] = {{0, b, a}, {b, a, 0}, {a, 0, b}};
        for (int k = 0; k < 3; k++)
            add_dodecahedron_face(s, normal[k]);
    }
}

void make_torus(polyhedron *s, int n, int m) {
    begin(s);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < m; j++) {
            double u = 2 * PI * i / n, w = 2 * PI * j / m;
            add_vertex(s, (2 + cos(w)) * cos(u), (2 + cos(w)) * sin(u), sin(w));
        }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < m; j++) {
            int32_t a = i * m + j, b = (i + 1) % n * m + j;
            int32_t c = (i + 1) % n * m + (j + 1) % m, d = i * m + (j + 1) % m;
            add_face(s, 3, (int32_t[]){a, b, c});
            add_face(s, 3, (int32_t[]){a, c, d});
        }
}

void make_prism_box(polyhedron *s) {
    begin(s);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 6; i++)
            add_vertex(s, cos(PI * i / 3), sin(PI * i / 3), k);
    add_face(s, 6, (int32_t[]){5, 4, 3, 2, 1, 0});
    add_face(s, 6, (int32_t[]){6, 7, 8, 9, 10, 11});
    for (int32_t i = 0; i < 6; i++)
        add_face(s, 4, (int32_t[]){i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i});
}

void make_cylinder(cylinder *c) {
    for (int x = 1; x <= 720; x++) { /* the seed counts from 1 */
        int ring = x > 360;
        c->alpha[x - 1] = (x == 360 ? 1 : x == 720 ? 361 : x + 1) - 1;
        c->beta[x - 1] = (x <= 360 ? 360 + x : x) - 1;
        double angle = 2 * PI * (x - 360 * ring) / 360;
        c->g[3 * (x - 1)] = cos(angle);
        c->g[3 * (x - 1) + 1] = sin(angle);
        c->g[3 * (x - 1) + 2] = ring;
    }
}
