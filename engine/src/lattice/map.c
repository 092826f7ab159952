#include "lattice/map.h"

#include <math.h>
#include <stddef.h>

#include "base/memory.h"
#include "base/series.h"

static const double pi = 3.14159265358979323846;

/* What u, v, w are: a variable, or something of the map's own. */
enum { TURNS = -1, LATITUDE = -2, RADIUS = -3 };

static const int8_t coordinates[ISO_LATTICE_MAP_COUNT][3] = {
    [ISO_LATTICE_MAP_XYZ] = {GRADING_X, GRADING_Y, GRADING_Z},
    [ISO_LATTICE_MAP_CYLINDER] = {TURNS, GRADING_Z, GRADING_R},
    [ISO_LATTICE_MAP_SPHERE] = {TURNS, LATITUDE, RADIUS},
    [ISO_LATTICE_MAP_SKIN] = {GRADING_X, GRADING_Y, GRADING_SKIN},
    [ISO_LATTICE_MAP_SKIN_CYLINDER] = {TURNS, GRADING_Z, GRADING_SKIN},
};

uint32_t map_wants(int32_t kind) {
    uint32_t wanted = 0;
    for (int k = 0; k < 3; k++)
        if (coordinates[kind][k] >= 0)
            wanted |= (uint32_t)1 << coordinates[kind][k];
    return wanted;
}

bool map_is_even(const iso_cell_map *map) {
    return coordinates[map->kind][0] != TURNS;
}

/* ---- making ---- */

/* Cells are counted along the only variable that their size depends on, if the map has it: or, in
 * x, y and z, along r too, as both x and y grow with it. */
static int32_t find_counted(int32_t kind, const iso_grading *size) {
    int32_t only = grading_only_variable(size);
    for (int k = 0; k < 3 && only >= 0; k++)
        if (coordinates[kind][k] == only)
            return only;
    return only == GRADING_R && kind == ISO_LATTICE_MAP_XYZ ? only : -1;
}

static void find_range(double range[2], const iso_space *space, int32_t variable) {
    iso_vec3 max = space->max;
    double side = 2 * (max.x < max.y ? max.x : max.y);
    const double largest[GRADING_VARIABLES] = {
        [GRADING_X] = max.x,
        [GRADING_Y] = max.y,
        [GRADING_Z] = max.z,
        [GRADING_SKIN] = (side < max.z ? side : max.z) / 2,
        [GRADING_R] = sqrt(max.x * max.x + max.y * max.y),
    };
    range[1] = largest[variable];
    range[0] = variable == GRADING_X || variable == GRADING_Y ? -range[1] : 0;
}

/* Cells from map->first on, in map->cells, by Simpson's rule; `size` is at each step's begin,
 * middle and end. */
static void add_up(iso_cell_map *map, const double *size) {
    double sum = 0;
    map->cells[0] = 0;
    for (int32_t i = 0; i < MAP_STEPS; i++) {
        const double *at = size + 2 * i;
        sum += (1 / at[0] + 4 / at[1] + 1 / at[2]) * map->step / 6;
        map->cells[i + 1] = sum;
    }
}

/* Beyond the ends the cells stay as large as there. */
static double cells_at(const iso_cell_map *map, double length) {
    double at = (length - map->first) / map->step;
    int32_t i = at >= MAP_STEPS - 1 ? MAP_STEPS - 1 : at > 0 ? (int32_t)at : 0;
    return map->cells[i] + (at - i) * (map->cells[i + 1] - map->cells[i]);
}

static iso_status count_cells(iso_cell_map *map, const iso_space *space, const iso_grading *size,
                              double least) {
    static const char *const names[GRADING_VARIABLES] = {"x", "y", "z", "skin", "r", "grid"};
    enum { SAMPLES = 2 * MAP_STEPS + 1 };
    double range[2], *at = NULL;
    const double *variable[GRADING_VARIABLES] = {NULL};
    find_range(range, space, map->counted);
    map->first = range[0];
    map->step = (range[1] - range[0]) / MAP_STEPS;
    ISO_TRY(ISO_ALLOCATE(map->cells, MAP_STEPS + 1));
    ISO_TRY(ISO_ALLOCATE(at, SAMPLES));
    for (int32_t i = 0; i < SAMPLES; i++)
        at[i] = range[0] + map->step / 2 * i;
    variable[map->counted] = at;
    grading_evaluate(at, size, variable, SAMPLES);
    iso_status status = ISO_OK;
    for (int32_t i = 0; i < SAMPLES && status == ISO_OK; i++) {
        if (!(at[i] >= least && at[i] < HUGE_VAL))
            status = iso_fail(ISO_BAD_CONFIG,
                              "lattice_cell is %.4g mm at %s = %.4g; it must be %g mm or more",
                              at[i], names[map->counted], range[0] + map->step / 2 * i, least);
        map->smallest = at[i] < map->smallest ? at[i] : map->smallest;
    }
    if (status == ISO_OK) {
        add_up(map, at);
        double zero = cells_at(map, 0);
        for (int32_t i = 0; i <= MAP_STEPS; i++)
            map->cells[i] -= zero;
    }
    iso_release(at);
    return status;
}

/* As many cells as fit at the mean radius, by their size at one place there. */
static double cells_around(int32_t kind, const iso_space *space, const iso_grading *size,
                           int32_t repeat) {
    double radius = kind == ISO_LATTICE_MAP_SPHERE ? space->mean_radius : space->mean_r;
    iso_places places;
    uint32_t wanted = 0;
    for (int32_t k = 0; k < GRADING_VARIABLES; k++)
        wanted |= (uint32_t)grading_uses(size, k) << k;
    places.value[GRADING_X][0] = radius;
    places.value[GRADING_Y][0] = 0;
    places.value[GRADING_Z][0] = space->max.z / 2;
    space_know(&places, space, wanted, 1);
    double edge, around;
    grading_evaluate(&edge, size, places.variable, 1);
    around = floor(2 * pi * radius / edge / repeat + 0.5) * repeat;
    return around >= repeat && around < 1e6 ? around : repeat;
}

iso_status map_make(iso_cell_map *map, int32_t kind, const iso_space *space,
                    const iso_grading *size, int32_t repeat, double least) {
    if (kind < 0 || kind >= ISO_LATTICE_MAP_COUNT)
        return iso_fail(ISO_BAD_CONFIG, "there is no lattice_map %d", (int)kind);
    *map = (iso_cell_map){.kind = kind,
                          .middle_z = space->max.z / 2,
                          .counted = find_counted(kind, size),
                          .smallest = HUGE_VAL};
    if (!map_is_even(map))
        map->around = cells_around(kind, space, size, repeat);
    iso_status status = map->counted >= 0 ? count_cells(map, space, size, least) : ISO_OK;
    if (status != ISO_OK)
        map_free(map);
    return status;
}

void map_free(iso_cell_map *map) {
    iso_release(map->cells);
    map->cells = NULL;
}

/* ---- places ---- */

static void turn(double *to, const iso_cell_map *map, const iso_places *places, int32_t count) {
    const double *x = places->value[GRADING_X], *y = places->value[GRADING_Y];
    for (int32_t i = 0; i < count; i++)
        to[i] = series_arctangent2(y[i], x[i]) * (map->around / (2 * pi));
}

/* Distance from the middle, and how high above the equator. */
static double from_middle(double *height, const iso_cell_map *map, const iso_places *places,
                          int32_t i) {
    double x = places->value[GRADING_X][i], y = places->value[GRADING_Y][i];
    *height = places->value[GRADING_Z][i] - map->middle_z;
    return sqrt(x * x + y * y + *height * *height);
}

static double flat_radius(const iso_places *places, int32_t i) {
    double x = places->value[GRADING_X][i], y = places->value[GRADING_Y][i];
    return sqrt(x * x + y * y);
}

static void globe(double *to, const iso_cell_map *map, int32_t coordinate, const iso_places *places,
                  const double *size, int32_t count) {
    for (int32_t i = 0; i < count; i++) {
        double height, radius = from_middle(&height, map, places, i);
        to[i] = coordinate == RADIUS
                    ? radius / size[i]
                    : series_arctangent2(height, flat_radius(places, i)) * (map->around / (2 * pi));
    }
}

static void lengths(double *to, const iso_cell_map *map, int32_t variable, const iso_places *places,
                    const double *size, int32_t count) {
    const double *length = places->value[variable], *r = places->value[GRADING_R];
    bool along_r = map->counted == GRADING_R && variable != GRADING_R && variable != GRADING_Z;
    for (int32_t i = 0; i < count; i++) {
        if (variable == map->counted)
            to[i] = cells_at(map, length[i]);
        else if (along_r && r[i] > map->step)
            to[i] = length[i] * (cells_at(map, r[i]) / r[i]);
        else
            to[i] = length[i] / size[i];
    }
}

void map_cells(iso_cell_places cells, const iso_cell_map *map, const iso_places *places,
               const double *size, int32_t count) {
    for (int k = 0; k < 3; k++) {
        int32_t coordinate = coordinates[map->kind][k];
        if (coordinate == TURNS)
            turn(cells[k], map, places, count);
        else if (coordinate < 0)
            globe(cells[k], map, coordinate, places, size, count);
        else
            lengths(cells[k], map, coordinate, places, size, count);
    }
}

void map_stretch(iso_cell_places stretch, const iso_cell_map *map, const iso_places *places,
                 const double *size, int32_t count) {
    const double least = 1e-6; /* mm, on the axis */
    double turns = 2 * pi / map->around;
    for (int32_t i = 0; i < count; i++) {
        double height, r = flat_radius(places, i);
        for (int k = 0; k < 3; k++)
            stretch[k][i] = size[i];
        if (map_is_even(map))
            continue;
        stretch[0][i] = r * turns > least ? r * turns : least;
        if (map->kind == ISO_LATTICE_MAP_SPHERE) {
            double radius = from_middle(&height, map, places, i);
            stretch[1][i] = radius * turns > least ? radius * turns : least;
        }
    }
}
