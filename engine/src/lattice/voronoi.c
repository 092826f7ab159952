#include "lattice/voronoi.h"

#include <math.h>

#include "base/memory.h"
#include "base/sort.h"
#include "base/random.h"

/* With a site in each cell no point is further than sqrt(3) cells from one, so neighbours are no
 * further than twice that from each other: within so many cells each way. */
enum { NEAR_CELLS = 4, NEAR_MAX = 9 * 9 * 9, CORNERS_MAX = 64 };

typedef struct neighbour {
    double way[3], half; /* from the site; half its square: the bisector is way . p = half */
    int32_t site;
} neighbour;

typedef struct polygon { /* a face: side i, from corner i to the next, is a neighbour's */
    double corner[CORNERS_MAX][3];
    int32_t side[CORNERS_MAX];
    int32_t count;
} polygon;

typedef struct work {
    iso_voronoi *out;
    int32_t cells;
    double cell; /* edge of one, steps */
    int64_t face_capacity, edge_capacity;
    neighbour near[NEAR_MAX];
    int32_t near_count;
} work;

static inline int is_nearer(const neighbour *p, const neighbour *q) {
    return p->half != q->half ? p->half < q->half : p->site < q->site;
}
ISO_SORT(sort_neighbours, neighbour, is_nearer)

static double dot(const double *p, const double *q) {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

static void place_sites(work *w, double jitter, uint64_t seed) {
    for (int32_t s = 0; s < w->out->count; s++) {
        int32_t at[3] = {s % w->cells, s / w->cells % w->cells, s / w->cells / w->cells};
        for (int a = 0; a < 3; a++)
            w->out->site[s][a] = w->cell * (at[a] + 0.5 + jitter * (random_unit(&seed) - 0.5));
    }
}

static void find_neighbours(work *w, int32_t site) {
    int32_t n = w->cells, x = site % n, y = site / n % n, z = site / n / n;
    double most = 6 * w->cell * w->cell; /* half the square of 2 sqrt(3) cells */
    w->near_count = 0;
    for (int32_t k = z - NEAR_CELLS; k <= z + NEAR_CELLS; k++)
        for (int32_t j = y - NEAR_CELLS; j <= y + NEAR_CELLS; j++)
            for (int32_t i = x - NEAR_CELLS; i <= x + NEAR_CELLS; i++) {
                int32_t at[3] = {i, j, k}, in[3];
                neighbour m;
                for (int a = 0; a < 3; a++)
                    in[a] = (at[a] + 2 * n) % n;
                m.site = in[0] + n * (in[1] + n * in[2]);
                for (int a = 0; a < 3; a++)
                    m.way[a] =
                        w->out->site[m.site][a] + w->cell * (at[a] - in[a]) - w->out->site[site][a];
                m.half = 0.5 * dot(m.way, m.way);
                if (m.half > 0 && m.half <= most)
                    w->near[w->near_count++] = m;
            }
    sort_neighbours(w->near, w->near_count);
}

/* A square on the bisector, larger than any face. */
static void start_face(polygon *p, const work *w, const neighbour *m) {
    double length = sqrt(2 * m->half), u[3], v[3], n[3];
    for (int a = 0; a < 3; a++)
        n[a] = m->way[a] / length;
    int thin = fabs(n[0]) <= fabs(n[1]) ? (fabs(n[0]) <= fabs(n[2]) ? 0 : 2)
                                        : (fabs(n[1]) <= fabs(n[2]) ? 1 : 2);
    for (int a = 0; a < 3; a++)
        u[a] = (a == thin) - n[thin] * n[a];
    double scale = 4 * w->cell / sqrt(dot(u, u));
    for (int a = 0; a < 3; a++)
        u[a] *= scale;
    for (int a = 0; a < 3; a++)
        v[a] = n[(a + 1) % 3] * u[(a + 2) % 3] - n[(a + 2) % 3] * u[(a + 1) % 3];
    static const int sign[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    p->count = 4;
    for (int i = 0; i < 4; i++) {
        p->side[i] = -1;
        for (int a = 0; a < 3; a++)
            p->corner[i][a] = 0.5 * m->way[a] + sign[i][0] * u[a] + sign[i][1] * v[a];
    }
}

static void cross(double *out, const double *p, const double *q, double hp, double hq) {
    double t = hp / (hp - hq);
    for (int a = 0; a < 3; a++)
        out[a] = p[a] + t * (q[a] - p[a]);
}

/* What of the polygon is nearer to the site than to neighbour `by`. A convex polygon gains one
 * corner at most. */
static void clip(polygon *p, const neighbour *m, int32_t by) {
    polygon kept;
    int outside = 0;
    double height[CORNERS_MAX];
    for (int32_t i = 0; i < p->count; i++) {
        height[i] = dot(m->way, p->corner[i]) - m->half;
        outside |= height[i] > 0;
    }
    if (!outside)
        return;
    kept.count = 0;
    for (int32_t i = 0; i < p->count; i++) {
        int32_t next = i + 1 < p->count ? i + 1 : 0;
        int in = height[i] <= 0, goes = in != (height[next] <= 0);
        if (in && kept.count < CORNERS_MAX) {
            memcpy(kept.corner[kept.count], p->corner[i], sizeof *kept.corner);
            kept.side[kept.count++] = p->side[i];
        }
        if (goes && kept.count < CORNERS_MAX) {
            cross(kept.corner[kept.count], p->corner[i], p->corner[next], height[i], height[next]);
            kept.side[kept.count++] = in ? by : p->side[i];
        }
    }
    p->count = kept.count;
    memcpy(p->corner, kept.corner, (size_t)kept.count * sizeof *kept.corner);
    memcpy(p->side, kept.side, (size_t)kept.count * sizeof *kept.side);
}

/* An edge is seen from three sites, and from each on two faces: kept where these come in order. */
static iso_status keep_edges(work *w, const polygon *p, int32_t site, int32_t other) {
    iso_voronoi *out = w->out;
    ISO_TRY(ISO_GROW(out->edge, w->edge_capacity, out->edge_count + p->count));
    for (int32_t i = 0; i < p->count && site <= other; i++) {
        const double *from = p->corner[i], *to = p->corner[i + 1 < p->count ? i + 1 : 0];
        iso_segment *e = &out->edge[out->edge_count];
        double square = 0;
        for (int a = 0; a < 3; a++) {
            e->from[a] = (float)(out->site[site][a] + from[a]);
            e->way[a] = (float)(to[a] - from[a]);
            square += (to[a] - from[a]) * (to[a] - from[a]);
        }
        int in_order = p->side[i] >= 0 && other <= w->near[p->side[i]].site;
        out->edge_count += in_order && square > 1e-8 * w->cell * w->cell;
    }
    return ISO_OK;
}

static iso_status make_cell(work *w, int32_t site) {
    iso_voronoi *out = w->out;
    int32_t faces = out->first[site];
    polygon p;
    find_neighbours(w, site);
    for (int32_t m = 0; m < w->near_count; m++) {
        start_face(&p, w, &w->near[m]);
        for (int32_t by = 0; by < w->near_count && p.count > 0; by++)
            if (by != m)
                clip(&p, &w->near[by], by);
        if (p.count < 3)
            continue;
        ISO_TRY(ISO_GROW(out->face, w->face_capacity, faces + 1));
        iso_voronoi_face *f = &out->face[faces++];
        double length = sqrt(2 * w->near[m].half);
        for (int a = 0; a < 3; a++)
            f->normal[a] = w->near[m].way[a] / length;
        f->offset = 0.5 * length;
        ISO_TRY(keep_edges(w, &p, site, w->near[m].site));
    }
    out->first[site + 1] = faces;
    return ISO_OK;
}

static iso_status make(work *w, double jitter, uint64_t seed) {
    iso_voronoi *out = w->out;
    ISO_TRY(ISO_ALLOCATE(out->site, out->count));
    ISO_TRY(ISO_ALLOCATE(out->first, out->count + 1));
    place_sites(w, jitter, seed);
    out->first[0] = 0;
    for (int32_t site = 0; site < out->count; site++)
        ISO_TRY(make_cell(w, site));
    return ISO_OK;
}

iso_status voronoi_make(iso_voronoi *out, int32_t cells, double size, double jitter,
                        uint64_t seed) {
    *out = (iso_voronoi){.count = cells * cells * cells};
    work *w;
    ISO_TRY(ISO_ALLOCATE(w, 1));
    *w = (work){.out = out, .cells = cells, .cell = size / cells};
    iso_status status = make(w, jitter, seed);
    iso_release(w);
    if (status != ISO_OK)
        voronoi_free(out);
    return status;
}

void voronoi_free(iso_voronoi *voronoi) {
    iso_release(voronoi->site);
    iso_release(voronoi->first);
    iso_release(voronoi->face);
    iso_release(voronoi->edge);
    *voronoi = (iso_voronoi){0};
}
