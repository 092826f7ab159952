#include "lattice/label.h"

#include "base/memory.h"

enum { DONE_MOST = 1000000 };

iso_status labels_begin(iso_labels *labels, iso_joining joining, int32_t columns, int32_t rows,
                        int32_t planes) {
    *labels = (iso_labels){.joining = joining, .columns = columns, .rows = rows, .planes = planes};
    labels->done_most = DONE_MOST;
    ISO_TRY(ISO_ALLOCATE(labels->at.row, (int64_t)rows + 1));
    ISO_TRY(ISO_ALLOCATE(labels->below.row, (int64_t)rows + 1));
    memset(labels->at.row, 0, ((size_t)rows + 1) * sizeof *labels->at.row);
    memset(labels->below.row, 0, ((size_t)rows + 1) * sizeof *labels->below.row);
    return ISO_OK;
}

void labels_free(iso_labels *labels) {
    iso_run_plane *plane[] = {&labels->at, &labels->below};
    for (int i = 0; i < 2; i++) {
        iso_release(plane[i]->row);
        iso_release(plane[i]->run);
    }
    iso_release(labels->parent);
    iso_release(labels->renamed);
    iso_release(labels->piece);
    iso_release(labels->spare);
    iso_release(labels->done);
    *labels = (iso_labels){0};
}

/* ---- union-find ---- */

int32_t labels_find(iso_labels *labels, int32_t label) {
    int32_t *parent = labels->parent;
    while (parent[label] != label) {
        parent[label] = parent[parent[label]];
        label = parent[label];
    }
    return label;
}

static int comes_before(const int32_t a[3], const int32_t b[3]) {
    for (int axis = 2; axis >= 0; axis--)
        if (a[axis] != b[axis])
            return a[axis] < b[axis];
    return 0;
}

static void merge_pieces(iso_piece *into, const iso_piece *from) {
    into->voxels += from->voxels;
    for (int axis = 0; axis < 3; axis++) {
        into->min[axis] = from->min[axis] < into->min[axis] ? from->min[axis] : into->min[axis];
        into->max[axis] = from->max[axis] > into->max[axis] ? from->max[axis] : into->max[axis];
    }
    if (comes_before(from->seed, into->seed)) {
        memcpy(into->seed, from->seed, sizeof into->seed);
        into->owner = from->owner;
    }
    into->on_border |= from->on_border;
}

/* The older label stays: trees stay low, since most runs meet one that has been there for long. */
static int32_t join(iso_labels *labels, int32_t a, int32_t b) {
    a = labels_find(labels, a), b = labels_find(labels, b);
    if (a == b)
        return a;
    int32_t into = a < b ? a : b, from = a < b ? b : a;
    labels->parent[from] = into;
    merge_pieces(&labels->piece[into], &labels->piece[from]);
    return into;
}

static iso_status new_label(iso_labels *labels, int32_t *label) {
    if (labels->count == INT32_MAX)
        return iso_fail(ISO_NO_MEMORY, "more than 2^31 pieces in one plane of voxels");
    ISO_TRY(ISO_GROW(labels->parent, labels->parent_capacity, labels->count + 1));
    ISO_TRY(ISO_GROW(labels->piece, labels->piece_capacity, labels->count + 1));
    *label = (int32_t)labels->count++;
    labels->parent[*label] = *label;
    return ISO_OK;
}

/* ---- one plane ---- */

static iso_status find_runs(iso_labels *labels, const uint8_t *voxel, uint8_t mask,
                            uint8_t wanted) {
    iso_run_plane *at = &labels->at;
    int32_t columns = labels->columns;
    at->count = 0;
    for (int32_t j = 0; j < labels->rows; j++) {
        const uint8_t *row = voxel + (int64_t)columns * j;
        at->row[j] = (int32_t)at->count;
        ISO_TRY(ISO_GROW(at->run, at->capacity, at->count + columns / 2 + 1));
        for (int32_t i = 0; i < columns;) {
            while (i < columns && (row[i] & mask) != wanted)
                i++;
            int32_t first = i;
            while (i < columns && (row[i] & mask) == wanted)
                i++;
            if (i > first)
                at->run[at->count++] = (iso_run){first, i, -1};
        }
        if (at->count > INT32_MAX)
            return iso_fail(ISO_NO_MEMORY, "more than 2^31 runs in one plane of voxels");
    }
    at->row[labels->rows] = (int32_t)at->count;
    return ISO_OK;
}

static int32_t owner_of(const iso_run_plane *owner, int32_t j, int32_t x, int32_t *from) {
    if (!owner)
        return -1;
    int32_t r = *from < owner->row[j] ? owner->row[j] : *from;
    while (r < owner->row[j + 1] && owner->run[r].end <= x)
        r++;
    *from = r;
    return r < owner->row[j + 1] ? owner->run[r].label : -1;
}

/* Join the runs of row j with those of a row beside it or below it; what has no label yet takes
 * over the other's, which saves a label for nearly every run. */
static void join_rows(iso_labels *labels, int32_t j, const iso_run_plane *other, int32_t row) {
    iso_run *at = labels->at.run;
    int32_t reach = labels->joining == ISO_JOIN_CORNERS;
    int32_t r = other->row[row], end = other->row[row + 1];
    for (int32_t a = labels->at.row[j]; a < labels->at.row[j + 1]; a++) {
        int32_t low = at[a].first - reach, high = at[a].end + reach;
        while (r < end && other->run[r].end <= low)
            r++;
        for (int32_t b = r; b < end && other->run[b].first < high; b++)
            at[a].label = at[a].label < 0 ? labels_find(labels, other->run[b].label)
                                          : join(labels, at[a].label, other->run[b].label);
    }
}

static void add_run(iso_piece *piece, const iso_run *run, int32_t j, int32_t k) {
    piece->voxels += run->end - run->first;
    piece->min[0] = run->first < piece->min[0] ? run->first : piece->min[0];
    piece->max[0] = run->end > piece->max[0] ? run->end - 1 : piece->max[0];
    piece->min[1] = j < piece->min[1] ? j : piece->min[1];
    piece->max[1] = j > piece->max[1] ? j : piece->max[1];
    piece->max[2] = k;
}

static int is_on_border(const iso_labels *labels, const iso_run *run, int32_t j) {
    return run->first == 0 || run->end == labels->columns || j == 0 || j == labels->rows - 1 ||
           labels->next == 0 || labels->next == labels->planes - 1;
}

static iso_status label_row(iso_labels *labels, int32_t j, const iso_run_plane *owner) {
    iso_run_plane *at = &labels->at;
    const iso_run_plane *below = &labels->below;
    int32_t from = 0, k = labels->next;
    join_rows(labels, j, below, j);
    if (j > 0)
        join_rows(labels, j, at, j - 1);
    if (labels->joining == ISO_JOIN_CORNERS && j > 0)
        join_rows(labels, j, below, j - 1);
    if (labels->joining == ISO_JOIN_CORNERS && j + 1 < labels->rows)
        join_rows(labels, j, below, j + 1);
    for (int32_t r = at->row[j]; r < at->row[j + 1]; r++) {
        iso_run *run = &at->run[r];
        int is_new = run->label < 0;
        if (is_new)
            ISO_TRY(new_label(labels, &run->label));
        iso_piece *piece = &labels->piece[labels_find(labels, run->label)];
        if (is_new)
            *piece = (iso_piece){.min = {run->first, j, k},
                                 .max = {run->end - 1, j, k},
                                 .seed = {run->first, j, k},
                                 .owner = owner_of(owner, j, run->first, &from)};
        add_run(piece, run, j, k);
        piece->on_border |= is_on_border(labels, run, j);
    }
    return ISO_OK;
}

static void lose(iso_labels *labels, const iso_piece *piece) {
    labels->lost++;
    labels->lost_voxels += piece->voxels;
    labels->lost_inner += !piece->on_border;
    labels->lost_inner_voxels += piece->on_border ? 0 : piece->voxels;
}

/* Crumbs without number, as of walls thinner than a voxel, are only counted: the smallest go until
 * half of the room is free. */
static void shed(iso_labels *labels) {
    while (labels->done_count > labels->done_most / 2) {
        int64_t kept = 0;
        labels->smallest = 2 * labels->smallest + 1;
        for (int64_t i = 0; i < labels->done_count; i++) {
            if (labels->done[i].voxels < labels->smallest)
                lose(labels, &labels->done[i]);
            else
                labels->done[kept++] = labels->done[i];
        }
        labels->done_count = kept;
    }
}

static iso_status complete(iso_labels *labels, const iso_piece *piece) {
    if (labels->done_count == labels->done_most)
        shed(labels);
    if (piece->voxels < labels->smallest) {
        lose(labels, piece);
        return ISO_OK;
    }
    ISO_TRY(ISO_GROW(labels->done, labels->done_capacity, labels->done_count + 1));
    labels->done[labels->done_count++] = *piece;
    return ISO_OK;
}

/* Number the labels of this plane from 0; what isn't among them is complete. */
static iso_status renumber(iso_labels *labels) {
    iso_run_plane *at = &labels->at;
    int64_t count = 0;
    ISO_TRY(ISO_GROW(labels->renamed, labels->renamed_capacity, labels->count));
    ISO_TRY(ISO_GROW(labels->spare, labels->spare_capacity, labels->count));
    for (int64_t i = 0; i < labels->count; i++)
        labels->renamed[i] = -1;
    for (int64_t r = 0; r < at->count; r++) {
        int32_t root = labels_find(labels, at->run[r].label);
        if (labels->renamed[root] < 0) {
            labels->renamed[root] = (int32_t)count;
            labels->spare[count++] = labels->piece[root];
        }
        at->run[r].label = labels->renamed[root];
    }
    for (int64_t i = 0; i < labels->count; i++)
        if (labels->parent[i] == i && labels->renamed[i] < 0)
            ISO_TRY(complete(labels, &labels->piece[i]));
    iso_piece *piece = labels->piece;
    int64_t capacity = labels->piece_capacity;
    labels->piece = labels->spare, labels->piece_capacity = labels->spare_capacity;
    labels->spare = piece, labels->spare_capacity = capacity;
    labels->count = count;
    for (int64_t i = 0; i < count; i++)
        labels->parent[i] = (int32_t)i;
    return ISO_OK;
}

iso_status labels_plane(iso_labels *labels, const uint8_t *voxel, uint8_t mask, uint8_t wanted,
                        const iso_run_plane *owner) {
    iso_run_plane swapped = labels->below;
    labels->below = labels->at;
    labels->at = swapped;
    ISO_TRY(find_runs(labels, voxel, mask, wanted));
    for (int32_t j = 0; j < labels->rows; j++)
        ISO_TRY(label_row(labels, j, owner));
    labels->next++;
    return labels->keep_all ? ISO_OK : renumber(labels);
}

iso_status labels_end(iso_labels *labels) {
    for (int64_t i = 0; i < labels->count; i++)
        if (labels->parent[i] == i)
            ISO_TRY(complete(labels, &labels->piece[i]));
    return ISO_OK;
}
