#include "fill/shapes.h"

#include <math.h>
#include <stdlib.h>

#include "check.h"

static const double pi = 3.14159265358979323846;

void add_points(iso_region *region, const iso_point *point, int count, int parent) {
    int32_t last = region->count ? region->first[region->count] : 0;
    region->first = realloc(region->first, ((size_t)region->count + 2) * sizeof *region->first);
    region->parent = realloc(region->parent, ((size_t)region->count + 1) * sizeof *region->parent);
    region->point = realloc(region->point, ((size_t)last + count) * sizeof *region->point);
    memcpy(region->point + last, point, (size_t)count * sizeof *point);
    region->first[region->count] = last;
    region->parent[region->count] = parent;
    region->first[++region->count] = last + count;
}

void drop_region(iso_region *region) {
    free(region->first);
    free(region->parent);
    free(region->point);
    *region = (iso_region){0};
}

double region_area(const iso_region *region) {
    double twice = 0;
    for (int i = 0; i < region->count; i++)
        for (int a = region->first[i + 1] - 1, b = region->first[i]; b < region->first[i + 1];
             a = b++)
            twice += (double)region->point[a].x * region->point[b].y -
                     (double)region->point[a].y * region->point[b].x;
    return twice / 2;
}

void add_contour(iso_region *region, const double (*point)[2], int count, double degrees,
                 int parent) {
    iso_point *turned = malloc((size_t)count * sizeof *turned);
    double c = cos(degrees * pi / 180), s = sin(degrees * pi / 180);
    for (int i = 0; i < count; i++)
        turned[i] = (iso_point){iso_units(c * point[i][0] - s * point[i][1]),
                                iso_units(s * point[i][0] + c * point[i][1])};
    add_points(region, turned, count, parent);
    free(turned);
}

void add_circle(iso_region *region, double x, double y, double radius, int corners, double degrees,
                int parent) {
    double(*point)[2] = malloc((size_t)corners * sizeof *point);
    for (int i = 0; i < corners; i++) {
        double t = 2 * pi * i / corners * (parent < 0 ? 1 : -1);
        point[i][0] = x + radius * cos(t);
        point[i][1] = y + radius * sin(t);
    }
    add_contour(region, (const double(*)[2])point, corners, degrees, parent);
    free(point);
}

static const double square_points[4][2] = {{0, 0}, {100, 0}, {100, 100}, {0, 100}};

static void square(iso_region *region, double degrees) {
    add_contour(region, square_points, 4, degrees, -1);
}

static void square_with_hole(iso_region *region, double degrees) {
    square(region, degrees);
    add_circle(region, 50, 50, 20, 64, degrees, 0);
}

static void plate(iso_region *region, double degrees) {
    square(region, degrees);
    for (int i = 0; i < 9; i++)
        add_circle(region, 20 + 30 * (i % 3), 20 + 30 * (i / 3), 9, 64, degrees, 0);
}

static void star(iso_region *region, double degrees) {
    double point[400][2];
    for (int i = 0; i < 400; i++) {
        double t = 2 * pi * i / 400, r = 50 + 18 * cos(7 * t);
        point[i][0] = r * cos(t);
        point[i][1] = r * sin(t);
    }
    add_contour(region, (const double(*)[2])point, 400, degrees, -1);
    add_circle(region, -12, 3, 8, 64, degrees, 0);
    add_circle(region, 15, -4, 8, 64, degrees, 0);
}

/* Ten teeth of 5 x 70 on a back of 100 x 20. */
static void comb(iso_region *region, double degrees) {
    double point[2 + 40][2] = {{0, 0}, {100, 0}};
    int count = 2;
    for (int tooth = 9; tooth >= 0; tooth--) {
        double x = 10 * tooth;
        const double corner[4][2] = {{x + 10, 20}, {x + 10, 90}, {x + 5, 90}, {x + 5, 20}};
        for (int i = 0; i < 4; i++, count++) {
            point[count][0] = corner[i][0];
            point[count][1] = corner[i][1];
        }
    }
    add_contour(region, (const double(*)[2])point, count, degrees, -1);
}

static void ring(iso_region *region, double degrees) {
    add_circle(region, 0, 0, 50, 200, degrees, -1);
    add_circle(region, 0, 0, 35, 200, degrees, 0);
}

/* A square frame with an island in it that has a hole of its own. */
static void island(iso_region *region, double degrees) {
    square(region, degrees);
    add_circle(region, 50, 50, 40, 100, degrees, 0);
    add_circle(region, 50, 50, 25, 100, degrees, -1);
    region->parent[2] = 1;
    add_circle(region, 50, 50, 10, 100, degrees, 2);
}

void make_disc(iso_region *region) {
    add_circle(region, 0, 0, 100, 2000, 0, -1);
    for (int i = 0; i < 50; i++) {
        double radius = 12 + 11 * sqrt(i), turn = 2.399963 * i; /* a sunflower's seeds */
        add_circle(region, radius * cos(turn), radius * sin(turn), 3.5, 100, 0, 0);
    }
}

const shape shapes[] = {
    {"square", square}, {"square with hole", square_with_hole},
    {"plate", plate},   {"star", star},
    {"comb", comb},     {"ring", ring},
    {"island", island},
};
const int shape_count = sizeof shapes / sizeof *shapes;
