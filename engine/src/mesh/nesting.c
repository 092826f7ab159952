#include "mesh/nesting.h"

#include "base/memory.h"

/* Shell `around` surrounds shell `inner` `winding` times. */
typedef struct nest {
    int32_t inner, around, winding;
} nest;

/* Where a shell asks what is around it: a point on it, and the way into it. */
typedef struct probe {
    iso_vec3 at, in;
} probe;

/* mm. A face this close to a probe touches it, and it counts on which side of it the way in leads.
 * Far below anything that is printed, far above rounding. */
#define TOUCH 1e-6

typedef struct nesting {
    const iso_mesh *mesh;
    const int32_t *shell;
    int32_t shells;
    probe *probe;  /* [shell] */
    int32_t *by_x; /* [shell] shells by their probe's x */
    nest *nests;   /* one a hit at first, later one a pair of shells, sorted */
    int64_t count, capacity;
    int32_t *depth;   /* [shell] how many are around it */
    int32_t *inwards; /* [shell] by depth */
} nesting;

static iso_vec3 normal_of(const iso_vec3 *p, const iso_vec3 *q, const iso_vec3 *r) {
    double ux = q->x - p->x, uy = q->y - p->y, uz = q->z - p->z;
    double vx = r->x - p->x, vy = r->y - p->y, vz = r->z - p->z;
    return (iso_vec3){uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
}

static void find_probes(nesting *n, const double *volume) {
    for (int32_t t = n->mesh->triangle_count - 1; t >= 0; t--) {
        iso_vec3 p = n->mesh->position[n->mesh->origin[3 * t]];
        iso_vec3 q = n->mesh->position[n->mesh->origin[3 * t + 1]];
        iso_vec3 r = n->mesh->position[n->mesh->origin[3 * t + 2]];
        iso_vec3 in = normal_of(&p, &q, &r);
        if (volume[n->shell[t]] >= 0)
            in = (iso_vec3){-in.x, -in.y, -in.z};
        n->probe[n->shell[t]].at =
            (iso_vec3){(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3, (p.z + q.z + r.z) / 3};
        n->probe[n->shell[t]].in = in;
    }
}

/* Heap sort of 0 .. count - 1 by a strict order. */
static void sort_by(int32_t *item, int32_t count, const nesting *n,
                    bool (*before)(const nesting *, int32_t, int32_t)) {
    for (int32_t i = 0; i < count; i++)
        item[i] = i;
    for (int32_t start = count / 2, end = count; end > 1;) {
        int32_t swap;
        if (start > 0)
            start--;
        else
            end--, swap = item[end], item[end] = item[0], item[0] = swap;
        for (int32_t root = start, child; (child = 2 * root + 1) < end; root = child) {
            if (child + 1 < end && before(n, item[child], item[child + 1]))
                child++;
            if (!before(n, item[root], item[child]))
                break;
            swap = item[root], item[root] = item[child], item[child] = swap;
        }
    }
}

static bool probe_before(const nesting *n, int32_t a, int32_t b) {
    double x = n->probe[a].at.x, y = n->probe[b].at.x;
    return x != y ? x < y : a < b;
}

static bool depth_before(const nesting *n, int32_t a, int32_t b) {
    return n->depth[a] != n->depth[b] ? n->depth[a] < n->depth[b] : a < b;
}

/* Does the edge cross the ray from q in the direction of +x, and which way? Half-open, and computed
 * the same from both sides, so that neighbours share every point between them. */
static int crossing(const iso_vec3 *a, const iso_vec3 *b, const iso_vec3 *q) {
    if ((a->y <= q->y) == (b->y <= q->y))
        return 0;
    int sign = 1;
    if (a->y > b->y) {
        const iso_vec3 *swap = a;
        a = b, b = swap, sign = -1;
    }
    double side = (b->x - a->x) * (q->y - a->y) - (b->y - a->y) * (q->x - a->x);
    return side > 0 ? sign : 0;
}

static double dot(iso_vec3 a, iso_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* How often the triangle's shadow winds around the probe, if the triangle is above it. */
static int winding_above(const iso_vec3 *p, const iso_vec3 *q, const iso_vec3 *r,
                         const probe *from) {
    const iso_vec3 *at = &from->at;
    int winding = crossing(p, q, at) + crossing(q, r, at) + crossing(r, p, at);
    if (winding == 0)
        return 0;
    iso_vec3 normal = normal_of(p, q, r);
    double side = dot(normal, (iso_vec3){at->x - p->x, at->y - p->y, at->z - p->z});
    if (side * side <= TOUCH * TOUCH * dot(normal, normal))
        side = dot(normal, from->in);
    return (winding > 0 ? side < 0 : side > 0) ? winding : 0;
}

static int32_t first_at(const nesting *n, double x) {
    int32_t low = 0, high = n->shells;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (n->probe[n->by_x[middle]].at.x < x)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static double least(double a, double b, double c) {
    a = a < b ? a : b;
    return a < c ? a : c;
}

/* Each triangle asks the probes in its range of x. With all shells in one column that is quadratic,
 * at a nanosecond or so a question; parts on a bed lie side by side. */
static iso_status find_hits(nesting *n) {
    for (int32_t t = 0; t < n->mesh->triangle_count; t++) {
        const iso_vec3 *p = &n->mesh->position[n->mesh->origin[3 * t]];
        const iso_vec3 *q = &n->mesh->position[n->mesh->origin[3 * t + 1]];
        const iso_vec3 *r = &n->mesh->position[n->mesh->origin[3 * t + 2]];
        double end = -least(-p->x, -q->x, -r->x);
        for (int32_t i = first_at(n, least(p->x, q->x, r->x)); i < n->shells; i++) {
            const probe *from = &n->probe[n->by_x[i]];
            if (from->at.x > end)
                break;
            int winding = n->by_x[i] == n->shell[t] ? 0 : winding_above(p, q, r, from);
            if (winding == 0)
                continue;
            ISO_TRY(ISO_GROW(n->nests, n->capacity, n->count + 1));
            n->nests[n->count++] = (nest){n->by_x[i], n->shell[t], winding};
        }
    }
    return ISO_OK;
}

static bool nest_before(const nest *a, const nest *b) {
    return a->inner != b->inner ? a->inner < b->inner : a->around < b->around;
}

static void sort_nests(nest *nests, int64_t count) {
    for (int64_t start = count / 2, end = count; end > 1;) {
        nest swap;
        if (start > 0)
            start--;
        else
            end--, swap = nests[end], nests[end] = nests[0], nests[0] = swap;
        for (int64_t root = start, child; (child = 2 * root + 1) < end; root = child) {
            if (child + 1 < end && nest_before(&nests[child], &nests[child + 1]))
                child++;
            if (!nest_before(&nests[root], &nests[child]))
                break;
            swap = nests[root], nests[root] = nests[child], nests[child] = swap;
        }
    }
}

/* Add up the hits of each pair; forget pairs that come to nothing. */
static void sum_hits(nesting *n) {
    int64_t kept = 0;
    sort_nests(n->nests, n->count);
    for (int64_t i = 0, j; i < n->count; i = j) {
        nest sum = n->nests[i];
        for (j = i + 1; j < n->count && !nest_before(&sum, &n->nests[j]); j++)
            sum.winding += n->nests[j].winding;
        if (sum.winding != 0)
            n->nests[kept++] = sum;
    }
    n->count = kept;
    memset(n->depth, 0, (size_t)n->shells * sizeof *n->depth);
    for (int64_t i = 0; i < n->count; i++)
        n->depth[n->nests[i].inner]++;
}

/* Index of the first nest of a shell. */
static int64_t first_nest(const nesting *n, int32_t inner) {
    int64_t low = 0, high = n->count;
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        if (n->nests[middle].inner < inner)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static void judge(bool *turned, const nesting *n, const double *volume) {
    for (int32_t i = 0; i < n->shells; i++) {
        int32_t inner = n->inwards[i], parent = -1;
        int64_t material = 0, first = first_nest(n, inner);
        for (int64_t k = first; k < first + n->depth[inner]; k++) {
            const nest *around = &n->nests[k];
            bool other_way = turned[around->around];
            material += other_way ? -around->winding : around->winding;
            if (parent < 0 || n->depth[around->around] > n->depth[parent])
                parent = around->around;
        }
        bool along = parent >= 0 && n->depth[parent] < n->depth[inner] && turned[parent];
        bool positive = volume[inner] > 0, negative = volume[inner] < 0;
        if (along && material > 0)
            turned[inner] = positive;
        else
            turned[inner] = negative && material <= 0;
    }
}

/* Sets count, nests and depth. */
static iso_status find_nests(nesting *n, const double *volume) {
    ISO_TRY(ISO_ALLOCATE(n->probe, n->shells));
    ISO_TRY(ISO_ALLOCATE(n->by_x, n->shells));
    ISO_TRY(ISO_ALLOCATE(n->depth, n->shells));
    find_probes(n, volume);
    sort_by(n->by_x, n->shells, n, probe_before);
    ISO_TRY(find_hits(n));
    sum_hits(n);
    return ISO_OK;
}

static iso_status find_inverted(bool *turned, nesting *n, const double *volume) {
    ISO_TRY(ISO_ALLOCATE(n->inwards, n->shells));
    memset(turned, 0, (size_t)n->shells * sizeof *turned);
    ISO_TRY(find_nests(n, volume));
    sort_by(n->inwards, n->shells, n, depth_before);
    judge(turned, n, volume);
    return ISO_OK;
}

static void nesting_free(nesting *n) {
    iso_release(n->probe);
    iso_release(n->by_x);
    iso_release(n->nests);
    iso_release(n->depth);
    iso_release(n->inwards);
}

iso_status iso_mesh_find_inverted(bool *turned, const iso_mesh *mesh, const int32_t *shell,
                                  const double *volume, int32_t shells) {
    nesting n = {.mesh = mesh, .shell = shell, .shells = shells};
    iso_status status = find_inverted(turned, &n, volume);
    nesting_free(&n);
    return status;
}

/* Of all that are around a shell, the one with most around itself. */
static void find_parents(int32_t *around, const nesting *n) {
    for (int32_t i = 0; i < n->shells; i++)
        around[i] = -1;
    for (int64_t k = 0; k < n->count; k++) {
        int32_t *parent = &around[n->nests[k].inner], outer = n->nests[k].around;
        if (*parent < 0 || n->depth[outer] > n->depth[*parent])
            *parent = outer;
    }
}

iso_status iso_mesh_find_around(int32_t *around, const iso_mesh *mesh, const int32_t *shell,
                                const double *volume, int32_t shells) {
    nesting n = {.mesh = mesh, .shell = shell, .shells = shells};
    iso_status status = find_nests(&n, volume);
    if (status == ISO_OK)
        find_parents(around, &n);
    nesting_free(&n);
    return status;
}
