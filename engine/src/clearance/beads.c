#include "clearance/beads.h"

#include <math.h>

#include "base/memory.h"
#include "base/sort.h"
#include "base/vector.h"

/* Runs are as short as makes boxes small, and long enough to make them few. */
#define RUN_EXTENT 6.0 /* mm */
enum { RUN_BEADS = 16 };

#define BOX_MARGIN 0.002f /* mm: more than all rounding here */

void beads_free(bead_store *beads) {
    for (int i = 0; i < beads->tree_count; i++)
        beads->table->tree_free(beads->tree[i]);
    for (int64_t i = 0; i * BEADS_BLOCK < beads->count; i++)
        iso_release(beads->block[i]);
    iso_release(beads->block);
    iso_release(beads->box);
    iso_release(beads->first);
    iso_release(beads->pair);
    *beads = (struct bead_store){0};
}

int64_t beads_bytes(const bead_store *beads) {
    return ((beads->count + BEADS_BLOCK - 1) / BEADS_BLOCK) * BEADS_BLOCK *
               (int64_t)sizeof(bead_packed) +
           beads->block_capacity * (int64_t)sizeof *beads->block +
           beads->box_capacity * (int64_t)sizeof *beads->box +
           beads->first_capacity * (int64_t)sizeof *beads->first +
           beads->pair_capacity * (int64_t)sizeof *beads->pair;
}

static bool is_place(iso_vec3 at) {
    double most = iso_mm(ISO_COORDINATE_MAX);
    return fabs(at.x) <= most && fabs(at.y) <= most && fabs(at.z) <= most;
}

static int16_t to_part(double x) {
    return (int16_t)(x * 32767 + (x < 0 ? -0.5 : 0.5));
}

enum { DOWN = 1 << 15 };

static uint16_t to_um(double mm, double z) {
    double um = fmin(DOWN - 1, fmax(1, mm * 1000 + 0.5));
    return (uint16_t)((uint16_t)um | (z < 0 ? DOWN : 0));
}

static void pack(int32_t at[3], int16_t normal[2], iso_vec3 place, iso_vec3 unit) {
    at[0] = iso_units(place.x);
    at[1] = iso_units(place.y);
    at[2] = iso_units(place.z);
    normal[0] = to_part(unit.x);
    normal[1] = to_part(unit.y);
}

static iso_vec3 place_of(const int32_t at[3]) {
    return vec3(iso_mm(at[0]), iso_mm(at[1]), iso_mm(at[2]));
}

static iso_vec3 normal_of(const int16_t n[2], bool down) {
    double x = n[0] / 32767.0, y = n[1] / 32767.0, z = sqrt(fmax(0, 1 - x * x - y * y));
    return vec3_unit(vec3(x, y, down ? -z : z));
}

int64_t beads_move(const bead_store *beads, int64_t i) {
    return beads->block[i / BEADS_BLOCK][i % BEADS_BLOCK].move;
}

bool beads_near(const bead_store *beads, int64_t i, const float box[6]) {
    const bead_packed *bead = &beads->block[i / BEADS_BLOCK][i % BEADS_BLOCK];
    /* um: nothing of a bead is farther from its line than its height and half its width. */
    int32_t around = (bead->width & ~DOWN) / 2 + (bead->height & ~DOWN) + 2;
    double most = around * (ISO_UNITS_PER_MM / 1000.0);
    for (int k = 0; k < 3; k++) {
        int32_t low = bead->from[k] < bead->to[k] ? bead->from[k] : bead->to[k];
        int32_t high = bead->from[k] < bead->to[k] ? bead->to[k] : bead->from[k];
        if (low - most > (double)box[3 + k] * ISO_UNITS_PER_MM ||
            high + most < (double)box[k] * ISO_UNITS_PER_MM)
            return false;
    }
    return true;
}

clearance_move beads_get(const bead_store *beads, int64_t i) {
    const bead_packed *bead = &beads->block[i / BEADS_BLOCK][i % BEADS_BLOCK];
    return (clearance_move){place_of(bead->from),
                            place_of(bead->to),
                            normal_of(bead->from_normal, bead->width & DOWN),
                            normal_of(bead->to_normal, bead->height & DOWN),
                            (bead->width & ~DOWN) / 1000.0,
                            (bead->height & ~DOWN) / 1000.0};
}

void beads_box(double low[3], double high[3], const clearance_move *bead) {
    double across = bead->width < bead->height ? bead->width : bead->height;
    double disc = (bead->width - across) / 2, ball = across / 2;
    for (int end = 0; end < 2; end++) {
        iso_vec3 tip = end ? bead->to : bead->from;
        iso_vec3 normal = end ? bead->to_normal : bead->from_normal;
        const double at[3] = {tip.x, tip.y, tip.z}, n[3] = {normal.x, normal.y, normal.z};
        for (int k = 0; k < 3; k++) {
            double middle = at[k] - ball * n[k];
            double around = ball + disc * sqrt(n[k] * n[k] < 1 ? 1 - n[k] * n[k] : 0);
            low[k] = end && low[k] < middle - around ? low[k] : middle - around;
            high[k] = end && high[k] > middle + around ? high[k] : middle + around;
        }
    }
}

/* Into the run that is open, or a new one. */
static void enter(bead_store *beads, const double low[3], const double high[3]) {
    float *box = beads->box + 6 * (int64_t)(beads->box_count - 1);
    bool fits = beads->box_count > 0 && beads->tree_first[beads->tree_count] < beads->box_count &&
                beads->count - beads->first[beads->box_count - 1] < RUN_BEADS;
    for (int k = 0; fits && k < 3; k++)
        fits = fmax(high[k], (double)box[3 + k]) - fmin(low[k], (double)box[k]) < RUN_EXTENT;
    if (!fits) {
        box = beads->box + 6 * (int64_t)beads->box_count;
        beads->first[beads->box_count++] = beads->count;
        for (int k = 0; k < 3; k++) {
            box[k] = INFINITY;
            box[3 + k] = -INFINITY;
        }
    }
    for (int k = 0; k < 3; k++) {
        box[k] = fminf(box[k], (float)low[k] - BOX_MARGIN);
        box[3 + k] = fmaxf(box[3 + k], (float)high[k] + BOX_MARGIN);
    }
    beads->first[beads->box_count] = beads->count + 1;
}

iso_status beads_add(bead_store *beads, const clearance_move *move, int64_t index) {
    if (!is_place(move->from) || !is_place(move->to) || index > UINT32_MAX ||
        beads->box_count > INT32_MAX - 2)
        return iso_fail(ISO_OUTSIDE,
                        "the print goes beyond what can be checked for collisions at "
                        "(%.3f, %.3f, %.3f) mm, move %lld",
                        move->to.x, move->to.y, move->to.z, (long long)index);
    int64_t block = beads->count / BEADS_BLOCK;
    ISO_TRY(ISO_GROW(beads->box, beads->box_capacity, 6 * ((int64_t)beads->box_count + 1)));
    ISO_TRY(ISO_GROW(beads->first, beads->first_capacity, (int64_t)beads->box_count + 2));
    if (beads->count % BEADS_BLOCK == 0) {
        ISO_TRY(ISO_GROW(beads->block, beads->block_capacity, block + 1));
        ISO_TRY(ISO_ALLOCATE(beads->block[block], BEADS_BLOCK));
    }
    bead_packed *bead = beads->block[block] + beads->count % BEADS_BLOCK;
    pack(bead->from, bead->from_normal, move->from, move->from_normal);
    pack(bead->to, bead->to_normal, move->to, move->to_normal);
    bead->width = to_um(move->width, move->from_normal.z);
    bead->height = to_um(move->height, move->to_normal.z);
    bead->move = (uint32_t)index;
    double low[3], high[3];
    beads_box(low, high, move);
    for (int k = 0; k < 3; k++) {
        beads->low[k] = beads->count ? fmin(beads->low[k], low[k]) : low[k];
        beads->high[k] = beads->count ? fmax(beads->high[k], high[k]) : high[k];
    }
    enter(beads, low, high);
    beads->count++;
    return ISO_OK;
}

/* Trees for all boxes there are. Boxes that are in one don't grow any more. */
static iso_status update(bead_store *beads) {
    const void *table = beads->table;
    if (!table)
        ISO_TRY(module_open(&table, ISO_MODULE_SOLID));
    beads->table = table;
    int count = beads->tree_count;
    int32_t end = beads->box_count, first = beads->tree_first[count];
    if (first == end)
        return ISO_OK;
    while (count > 0 &&
           (beads->tree_first[count] - beads->tree_first[count - 1] <= 2 * (end - first) ||
            count == BEADS_TREES))
        first = beads->tree_first[--count];
    solid_tree *tree;
    iso_status status = beads->table->tree_new(&tree, beads->box + 6 * (int64_t)first, end - first);
    if (status == ISO_NO_MEMORY)
        return iso_no_memory((size_t)(end - first) * 64);
    if (status != ISO_OK)
        return iso_fail(status, "Embree makes no tree of %d boxes of beads", end - first);
    for (int i = count; i < beads->tree_count; i++)
        beads->table->tree_free(beads->tree[i]);
    beads->tree[count] = tree;
    beads->tree_count = count + 1;
    beads->tree_first[count + 1] = end;
    return ISO_OK;
}

static inline int before(const beads_pair *a, const beads_pair *b) {
    return a->query != b->query ? a->query < b->query : a->box < b->box;
}

ISO_SORT(sort_pairs, beads_pair, before)

/* Those of one tree, behind `used` ones that are there. */
static iso_status find_in(int64_t *found, bead_store *beads, int tree, const solid_boxes *boxes,
                          int64_t used) {
    *found = 0;
    for (;;) {
        ISO_TRY(ISO_GROW(beads->pair, beads->pair_capacity, used + *found + 1024));
        int64_t room = beads->pair_capacity - used;
        iso_status status =
            beads->table->tree_boxes(&beads->pair[used].box, found, room, beads->tree[tree], boxes);
        if (status == ISO_NO_MEMORY)
            return iso_no_memory((size_t)boxes->count * 64);
        if (status != ISO_OK)
            return iso_fail(status, "Embree finds no boxes of beads");
        if (*found <= room)
            break;
    }
    for (int64_t k = used; k < used + *found; k++)
        beads->pair[k].box += beads->tree_first[tree];
    return ISO_OK;
}

iso_status beads_find(const beads_pair **pair, int64_t *pair_count, bead_store *beads,
                      const float *box, int32_t count) {
    ISO_TRY(update(beads));
    const solid_boxes boxes = {box, count};
    int64_t used = 0, found;
    for (int i = 0; i < beads->tree_count; i++, used += found)
        ISO_TRY(find_in(&found, beads, i, &boxes, used));
    sort_pairs(beads->pair, used);
    *pair = beads->pair;
    *pair_count = used;
    return ISO_OK;
}
