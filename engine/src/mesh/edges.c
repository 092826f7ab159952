#include "mesh/repair.h"

#include "base/memory.h"
#include "mesh/union_find.h"

static int32_t low_end(const iso_mesh *mesh, int32_t dart) {
    int32_t u = mesh->origin[dart], w = mesh->origin[iso_mesh_alpha(dart)];
    return u < w ? u : w;
}

static int32_t high_end(const iso_mesh *mesh, int32_t dart) {
    int32_t u = mesh->origin[dart], w = mesh->origin[iso_mesh_alpha(dart)];
    return u < w ? w : u;
}

/* Counting sort of `from` (the darts in order, if NULL) by one end of their edge; stable. */
static void sort_by_end(int32_t *to, const int32_t *from, int32_t *start, const iso_mesh *mesh,
                        int32_t (*end_of)(const iso_mesh *, int32_t)) {
    int32_t darts = 3 * mesh->triangle_count;
    memset(start, 0, ((size_t)mesh->vertex_count + 1) * sizeof *start);
    for (int32_t a = 0; a < darts; a++)
        start[end_of(mesh, a) + 1]++;
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        start[v + 1] += start[v];
    for (int32_t i = 0; i < darts; i++) {
        int32_t a = from ? from[i] : i;
        to[start[end_of(mesh, a)]++] = a;
    }
}

static bool same_edge(const iso_mesh *mesh, int32_t a, int32_t b) {
    return low_end(mesh, a) == low_end(mesh, b) && high_end(mesh, a) == high_end(mesh, b);
}

static iso_status find_edges(iso_mesh_edges *edges, const iso_mesh *mesh, int32_t *by_high,
                             int32_t *start) {
    int32_t darts = 3 * mesh->triangle_count;
    sort_by_end(by_high, NULL, start, mesh, high_end);
    sort_by_end(edges->dart, by_high, start, mesh, low_end);
    for (int32_t i = 0; i < darts; i++)
        edges->count += i == 0 || !same_edge(mesh, edges->dart[i - 1], edges->dart[i]);
    ISO_TRY(ISO_ALLOCATE(edges->first, edges->count + 1));
    int32_t count = 0;
    for (int32_t i = 0; i < darts; i++)
        if (i == 0 || !same_edge(mesh, edges->dart[i - 1], edges->dart[i]))
            edges->first[count++] = i;
    edges->first[count] = darts;
    return ISO_OK;
}

iso_status iso_mesh_edges_new(iso_mesh_edges *edges, const iso_mesh *mesh) {
    int64_t darts = 3 * (int64_t)mesh->triangle_count;
    int32_t *by_high = NULL, *start = NULL;
    *edges = (iso_mesh_edges){0};
    iso_status status = ISO_ALLOCATE(edges->dart, darts);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(by_high, darts);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(start, (int64_t)mesh->vertex_count + 1);
    if (status == ISO_OK)
        status = find_edges(edges, mesh, by_high, start);
    iso_release(by_high);
    iso_release(start);
    if (status != ISO_OK)
        iso_mesh_edges_free(edges);
    return status;
}

void iso_mesh_edges_free(iso_mesh_edges *edges) {
    iso_release(edges->first);
    iso_release(edges->dart);
    *edges = (iso_mesh_edges){0};
}

static bool is_good(const iso_mesh *mesh, const int32_t *dart, int32_t count) {
    return count == 2 && mesh->origin[dart[0]] != mesh->origin[dart[1]];
}

int64_t iso_mesh_edges_bad(const iso_mesh_edges *edges, const iso_mesh *mesh) {
    int64_t bad = 0;
    for (int64_t e = 0; e < edges->count; e++)
        bad += !is_good(mesh, edges->dart + edges->first[e], edges->first[e + 1] - edges->first[e]);
    return bad;
}

/* A triangle seen along its edge, from the edge's low vertex to the high one: the direction in
 * which it leaves, and whether its material begins there, going counter-clockwise. */
typedef struct leaf {
    double x, y;
    int32_t dart;
    int32_t patch; /* of triangles joined by good edges */
    bool begins;
} leaf;

static iso_vec3 minus(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static iso_vec3 cross(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double dot(iso_vec3 a, iso_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double size(double a) {
    return a < 0 ? -a : a;
}

static void find_leaves(leaf *leaves, const iso_mesh *mesh, int32_t *above, const int32_t *dart,
                        int32_t count) {
    int32_t low = low_end(mesh, dart[0]), high = high_end(mesh, dart[0]);
    iso_vec3 foot = mesh->position[low], axis = minus(mesh->position[high], foot);
    /* any two vectors that make a right-handed frame with the axis do: the order around it is the
     * same in all of them */
    iso_vec3 other = {0, 0, 1};
    if (size(axis.x) <= size(axis.y) && size(axis.x) <= size(axis.z))
        other = (iso_vec3){1, 0, 0};
    else if (size(axis.y) <= size(axis.z))
        other = (iso_vec3){0, 1, 0};
    iso_vec3 right = cross(axis, other), up = cross(axis, right);
    double scale = dot(axis, axis); /* |up|^2 = scale |right|^2 */
    for (int32_t i = 0; i < count; i++) {
        int32_t apex = mesh->origin[iso_mesh_alpha_inverse(dart[i])];
        iso_vec3 to = minus(mesh->position[apex], foot);
        leaves[i].x = dot(to, right) * dot(to, right) * scale;
        leaves[i].x = dot(to, right) < 0 ? -leaves[i].x : leaves[i].x;
        leaves[i].y = dot(to, up) < 0 ? -dot(to, up) * dot(to, up) : dot(to, up) * dot(to, up);
        leaves[i].dart = dart[i];
        leaves[i].patch = iso_root_of(above, dart[i] / 3);
        leaves[i].begins = mesh->origin[dart[i]] == high;
    }
}

/* Before in counter-clockwise order from the positive x axis. Squared components with their signs
 * keep the order of directions without a root. Sheets that coincide lie in one order where they
 * begin and in the other where they end, as the leaves of a book: so they pair with the same sheets
 * along all of their rim, and two solids with a face in common stay two even if one is inside out.
 */
static bool before(const leaf *a, const leaf *b) {
    bool a_lower = a->y < 0 || (a->y == 0 && a->x < 0);
    bool b_lower = b->y < 0 || (b->y == 0 && b->x < 0);
    if (a_lower != b_lower)
        return b_lower;
    double left = a->x * b->y, right = a->y * b->x;
    if (left != right)
        return left > right;
    if (a->begins != b->begins)
        return b->begins;
    bool earlier = a->patch != b->patch ? a->patch < b->patch : a->dart < b->dart;
    return a->dart != b->dart && earlier == a->begins;
}

static void sort_leaves(leaf *leaves, int32_t count) {
    /* heap sort: a star of any number of sheets may meet in one edge */
    for (int32_t start = count / 2, end = count; end > 1;) {
        if (start > 0) {
            start--;
        } else {
            leaf swap = leaves[--end];
            leaves[end] = leaves[0];
            leaves[0] = swap;
        }
        for (int32_t root = start, child; (child = 2 * root + 1) < end; root = child) {
            if (child + 1 < end && before(&leaves[child], &leaves[child + 1]))
                child++;
            if (!before(&leaves[root], &leaves[child]))
                break;
            leaf swap = leaves[root];
            leaves[root] = leaves[child];
            leaves[child] = swap;
        }
    }
}

/* Material begins and ends around the edge like brackets open and close: pair each end with the
 * last beginning before it. Twice around, since a pair may straddle where the count started. */
static int64_t pair_leaves(iso_mesh *mesh, leaf *leaves, int32_t count, int32_t *stack) {
    int32_t depth = 0;
    int64_t alone = count;
    for (int32_t i = 0; i < count; i++)
        mesh->opposite[leaves[i].dart] = -1;
    for (int32_t i = 0; i < 2 * count; i++) {
        int32_t a = leaves[i % count].dart;
        if (leaves[i % count].begins) {
            if (i < count)
                stack[depth++] = a;
        } else if (depth > 0 && mesh->opposite[a] < 0) {
            int32_t b = stack[--depth];
            mesh->opposite[a] = b;
            mesh->opposite[b] = a;
            alone -= 2;
        }
    }
    return alone;
}

/* Pair the good edges and find the patches that they hold together; returns the largest number of
 * darts on any other edge. */
static int32_t pair_good(iso_mesh *mesh, int32_t *above, const iso_mesh_edges *edges) {
    int32_t largest = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        above[t] = t;
    for (int64_t e = 0; e < edges->count; e++) {
        const int32_t *dart = edges->dart + edges->first[e];
        int32_t count = edges->first[e + 1] - edges->first[e];
        if (!is_good(mesh, dart, count)) {
            largest = count > largest ? count : largest;
            continue;
        }
        mesh->opposite[dart[0]] = dart[1];
        mesh->opposite[dart[1]] = dart[0];
        iso_join_roots(above, iso_root_of(above, dart[0] / 3), iso_root_of(above, dart[1] / 3));
    }
    return largest;
}

static int64_t pair_others(iso_mesh *mesh, int32_t *above, leaf *leaves, int32_t *stack,
                           const iso_mesh_edges *edges) {
    int64_t open = 0;
    for (int64_t e = 0; e < edges->count; e++) {
        const int32_t *dart = edges->dart + edges->first[e];
        int32_t count = edges->first[e + 1] - edges->first[e];
        if (is_good(mesh, dart, count))
            continue;
        find_leaves(leaves, mesh, above, dart, count);
        sort_leaves(leaves, count);
        open += pair_leaves(mesh, leaves, count, stack);
    }
    return open;
}

iso_status iso_mesh_edges_pair(int64_t *open, iso_mesh *mesh, const iso_mesh_edges *edges) {
    leaf *leaves = NULL;
    int32_t *stack = NULL, *above = NULL;
    *open = 0;
    ISO_TRY(ISO_ALLOCATE(above, mesh->triangle_count));
    int32_t largest = pair_good(mesh, above, edges);
    iso_status status = ISO_ALLOCATE(leaves, largest);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(stack, largest);
    if (status == ISO_OK && largest > 0)
        *open = pair_others(mesh, above, leaves, stack, edges);
    iso_release(above);
    iso_release(leaves);
    iso_release(stack);
    return status;
}
