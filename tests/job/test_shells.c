/* Under every top and over every bottom there are as many solid layers as were asked for: sparse
 * infill lies only where the sections of so many layers hold it, looked up one by one. */
#include "checks.h"
#include "solids.h"

static double layer_middle(const print *p, int32_t layer) {
    double top = 0;
    for (int32_t l = 0; l < layer; l++)
        top += p->level[l].height;
    return top + p->level[layer].height / 2;
}

typedef double (*pieces)[4];

/* Is the place surely outside of the layer, its edges not near? */
static int lacks(const pieces *piece, const int64_t *count, int32_t layer, double x, double y,
                 double near) {
    const double(*p)[4] = (const double(*)[4])piece[layer];
    return section_winding(p, count[layer], x, y) <= 0 &&
           section_distance(p, count[layer], x, y) > near;
}

static void check_shells(const print *p, const shape *s, int32_t top, int32_t bottom) {
    pieces *piece = calloc((size_t)p->level_count, sizeof *piece);
    int64_t *count = calloc((size_t)p->level_count, sizeof *count);
    shape_box3 b = shape_bounds(s);
    double dx = 100 - (b.min[0] + b.max[0]) / 2, dy = 100 - (b.min[1] + b.max[1]) / 2;
    for (int32_t l = 0; l < p->level_count; l++) {
        piece[l] = malloc((size_t)(s->count + 1) * sizeof *piece[l]);
        count[l] = shape_section(piece[l], s, b.min[2] + layer_middle(p, l));
    }
    int32_t bare = 0, at_end = 0, looked_at = 0;
    double spacing = 0.45;
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (!move_chosen(m, ISO_ROLE_INTERNAL_INFILL, -1) || m->layer % 3 != i % 3)
            continue;
        double x = (m->ax + m->bx) / 2 - dx, y = (m->ay + m->by) / 2 - dy;
        int32_t l = m->layer;
        looked_at++;
        at_end += l < bottom || l + top >= p->level_count;
        for (int32_t k = 1; k <= top && l + k < p->level_count; k++)
            bare += lacks(piece, count, l + k, x, y, 2 * spacing);
        for (int32_t k = 1; k <= bottom && l - k >= 0; k++)
            bare += lacks(piece, count, l - k, x, y, 2 * spacing);
    }
    CHECK(looked_at > 20);
    CHECK_EQUAL(0, at_end);
    CHECK_EQUAL(0, bare);
    for (int32_t l = 0; l < p->level_count; l++)
        free(piece[l]);
    free(piece);
    free(count);
}

static void test_sparse_is_covered(void) {
    static const struct {
        int32_t top, bottom;
    } shells[] = {{1, 1}, {3, 3}, {5, 2}, {2, 7}, {9, 0}, {0, 6}};
    for (int m = 0; m < SOLID_COUNT; m++) {
        shape s = {0};
        all_solids[m].make(&s);
        double size = shape_bounds(&s).max[2] - shape_bounds(&s).min[2];
        for (int c = 0; c < 6 && size > 4 && all_solids[m].full; c++) {
            char settings[160];
            print p;
            int before = check_failures;
            snprintf(settings, sizeof settings,
                     "top_solid_layers = %d\nbottom_solid_layers = %d\nperimeters = 1\n"
                     "layer_height = 0.2\nfill_density = 40%%\nsolid_infill_below_area = 0",
                     shells[c].top, shells[c].bottom);
            print_shape(&p, &s, settings);
            check_shells(&p, &s, shells[c].top, shells[c].bottom);
            if (check_failures > before)
                fprintf(stderr, "    that was %s with %d and %d\n", all_solids[m].name,
                        shells[c].top, shells[c].bottom);
            print_free(&p);
        }
        shape_free(&s);
    }
}

int main(void) {
    RUN(test_sparse_is_covered);
    CHECK(print_folder_remove());
    return check_verdict();
}
