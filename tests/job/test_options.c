/* Each option of the table has a row in one of the tables below (option_row.h). */
#include <stdlib.h>

#include "option_row.h"
#include "solids.h"

extern const option_row option_rows_print[], option_rows_machine[], option_rows_outline[],
    option_rows_bent[], option_rows_infill[], option_rows_speeds[], option_rows_gcode[],
    option_rows_dialect[], option_rows_paths[], option_rows_objects[], option_rows_special[],
    option_rows_moved[], option_rows_shells[], option_rows_walls[], option_rows_solid[],
    option_rows_lattice[], option_rows_lattice_part[], option_rows_curved[];

static const struct {
    const option_row *row;
    int bent; /* what they print can't be held against the model */
} table[] = {
    {option_rows_print, 0},        {option_rows_machine, 0}, {option_rows_outline, 0},
    {option_rows_bent, 1},         {option_rows_infill, 0},  {option_rows_speeds, 0},
    {option_rows_gcode, 0},        {option_rows_dialect, 1}, {option_rows_paths, 0},
    {option_rows_objects, 1},      {option_rows_special, 0}, {option_rows_moved, 1},
    {option_rows_shells, 0},       {option_rows_walls, 1},   {option_rows_lattice, 0},
    {option_rows_lattice_part, 1}, {option_rows_solid, 1},   {option_rows_curved, 1},
};

enum { TABLES = sizeof table / sizeof *table };

int same_places(const print *a, const print *b) {
    if (!CHECK_EQUAL(a->move_count, b->move_count))
        return 0;
    for (int32_t i = 0; i < a->move_count; i++)
        if (a->move[i].bx != b->move[i].bx || a->move[i].by != b->move[i].by ||
            a->move[i].bz != b->move[i].bz)
            return CHECK(!"the moves are the same");
    return 1;
}

int same_filament(const print *a, const print *b) {
    for (int32_t i = 0; i < a->move_count; i++)
        if (fabs(a->move[i].e - b->move[i].e) > 2e-5)
            return CHECK(!"the filament is the same");
    return 1;
}

/* What it stands on: a bundle of settings for both, then the option itself. */
static void print_row(print *a, print *b, const option_row *r, const shape *s) {
    char settings[1024];
    size_t length = strlen(r->base);
    print_shape(a, s, r->base);
    snprintf(settings, sizeof settings, "%s%s%s = %s", r->base,
             length == 0 || r->base[length - 1] == '\n' ? "" : "\n", r->key, r->value);
    print_shape(b, s, settings);
    /* The user may ask for less filament than was drawn back: the printer warns, and is right. */
    if (b->machine.unknown_commands > 0 &&
        CHECK(b->options.gcode_flavor > ISO_FLAVOUR_MARLIN || b->options.use_volumetric_e))
        b->machine.warning_count = 0; /* it is a Marlin, and one without M200 */
    if (b->options.retract_restart_extra < 0 && CHECK(b->machine.warning_count > 0))
        b->machine.warning_count = 0;
}

static void check_row(const option_row *r, int bent) {
    shape model = {0}, *s = &model;
    r->make(s);
    char line[1024], value[512];
    print a, b;
    int before = check_failures;
    print_row(&a, &b, r, s);
    if (bent) {
        check_machine(&a);
        check_machine(&b);
    } else {
        print_check(&a, s);
        print_check(&b, s);
    }
    if (a.status == ISO_OK && b.status == ISO_OK) {
        iso_options_format(value, sizeof value, &b.options, iso_option_find(r->key));
        snprintf(line, sizeof line, "\n; %s = %s\n", r->key, value);
        CHECK(strstr(b.text, line) && !strstr(a.text, line));
        r->check(&(change){&a, &b});
    }
    if (check_failures > before)
        fprintf(stderr, "    that was %s = %s\n", r->key, r->value);
    print_free(&a);
    print_free(&b);
    shape_free(s);
}

void make_block(shape *s) {
    shape_box(s, 0, 0, 0, 16, 16, 3);
}

void make_small(shape *s) {
    shape_box(s, 0, 0, 0, 9, 9, 3);
}

void make_part(shape *s) {
    const solid_ring ring[] = {{1, 0}, {1, 3}};
    solid_star(s, 5, 7, 0.15, 0, ring, 2, 96);
    shape_move(s, 0, s->count, 22, 6, 0);
    shape_box(s, 0, 0, 0, 12, 12, 3);
}

static int is_in_a_table(const char *key) {
    for (int t = 0; t < TABLES; t++)
        for (const option_row *r = table[t].row; r->key; r++)
            if (strcmp(r->key, key) == 0)
                return 1;
    return 0;
}

static void test_that_each_option_has_a_row(void) {
    for (int32_t o = 0; o < iso_option_count(); o++)
        if (!CHECK(is_in_a_table(iso_option_at(o)->key)))
            fprintf(stderr, "    %s has no row\n", iso_option_at(o)->key);
}

/* Every `shares`-th row from number `share` on, or those of a key. */
static void check_rows(int share, int shares, const char *key) {
    int number = 0, checked = 0;
    for (int t = 0; t < TABLES; t++)
        for (const option_row *r = table[t].row; r->key; r++, number++)
            if (key ? strcmp(key, r->key) == 0 : number % shares == share % shares) {
                CHECK(iso_option_find(r->key) >= 0);
                check_row(r, table[t].bent);
                checked++;
            }
    CHECK(checked > 0);
    printf("%d of %d rows\n", checked, number);
}

/* test-job-options [SHARE SHARES | KEY] */
int main(int argc, char **argv) {
    RUN(test_that_each_option_has_a_row);
    if (argc == 3 && CHECK(atoi(argv[2]) > 0))
        check_rows(atoi(argv[1]), atoi(argv[2]), NULL);
    else
        check_rows(0, 1, argc == 2 ? argv[1] : NULL);
    CHECK(print_folder_remove());
    return check_verdict();
}
