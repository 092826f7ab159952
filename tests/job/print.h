/* Jobs for tests: a model and some options become G-code in memory, read back here with strtod and
 * run on the virtual printer. */
#ifndef TESTS_JOB_PRINT_H
#define TESTS_JOB_PRINT_H

#include <isoprint/virtual_printer.h>
#include <isoslice/job.h>

#include "models/shapes.h"

typedef enum move_kind { MOVE_DRAW, MOVE_TRAVEL, MOVE_RISE, MOVE_FILAMENT } move_kind;

typedef struct print_move {
    double ax, ay, az, bx, by, bz; /* mm */
    double e;                      /* mm of filament */
    double f;                      /* mm/min */
    double width;                  /* mm, as ";WIDTH:" says */
    double fan;                    /* percent */
    int32_t layer;                 /* -1 before the first one */
    int32_t run; /* numbers the unbroken strings of drawing moves of one role, from 0 */
    int role;    /* iso_role, -1 unknown */
    int tool;
    move_kind kind;
} print_move;

typedef struct print_level {
    double z, height; /* as ";Z:" and ";HEIGHT:" say */
    int32_t first;    /* move */
} print_level;

typedef struct print {
    iso_status status;
    char message[512];
    iso_options options;
    iso_report report;
    char *text; /* ends with a 0; NULL if there is no file */
    size_t size;
    print_move *move;
    int32_t move_count, move_room;
    print_level *level; /* [level_count + 1]; the last one holds the end of the moves */
    int32_t level_count, level_room;
    int relative;
    fio_status verdict; /* of the printer */
    char complaint[512];
    fio_statistics machine;
    fio_state state;
} print;

/* A path in a folder of this process, the same for the same name. */
const char *print_path(const char *name);
int print_folder_remove(void); /* with all files that print_path() named; 0 if more is in it */

/* Defaults, then "key = value" lines, or none; 0 if one is refused. */
int print_options(iso_options *options, const char *settings);

/* Run a job, read its G-code and print it. Free the print in any case. */
void print_files(print *p, const char *const *path, int32_t count, const char *settings,
                 int32_t threads);
void print_shape(print *p, const shape *s, const char *settings);
void print_free(print *p);

double print_volume(const print *p);     /* mm^3 of plastic, skirts left out, at multiplier 1 */
double move_length(const print_move *m); /* in the plane */
int move_chosen(const print_move *m, int role, int32_t layer); /* as below */

/* Sums over drawing moves of a role (-1: all but skirts) on a layer (-1: all). */
double print_length(const print *p, int role, int32_t layer);
double print_filament(const print *p, int role, int32_t layer);
int32_t print_runs(const print *p, int role, int32_t layer);
/* Box of the middles of the beads: lowest x, lowest y, highest x, highest y; 0 if there are none.
 */
int print_box(double box[4], const print *p, int role, int32_t layer);

/* ---- the model, by the tests' own means ---- */

typedef struct shape_box3 {
    double min[3], max[3];
} shape_box3;
shape_box3 shape_bounds(const shape *s);
/* Area at height z of what the triangles enclose, corners at z counting as below: each triangle
 * adds its own piece of the contour integral, whatever its neighbours are. */
double shape_area_at(const shape *s, double z);
/* The section's pieces, x y x y each: how many, at most s->count. */
int64_t shape_section(double (*piece)[4], const shape *s, double z);
/* Winding number of the pieces around a point, and its distance to the nearest. */
int section_winding(const double (*piece)[4], int64_t count, double x, double y);
double section_distance(const double (*piece)[4], int64_t count, double x, double y);
double shape_volume(const shape *s);
double shape_surface(const shape *s); /* mm^2 */
/* Sum of the sections in the middles of the print's layers times their heights. */
double shape_layered_volume(const shape *s, const print *p);

#endif
