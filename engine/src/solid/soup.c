/* Solid angles, added up. Clusters of triangles that are far away are taken as a dipole and a
 * quadrupole (Barill, Dickson, Schmidt, Levin and Jacobson, Fast Winding Numbers for Soups and
 * Clouds, 2018), so that a point costs O(log n). */
#include "solid/soup.h"

#include <math.h>

#include "base/memory.h"
#include "base/series.h"
#include "solid/halves.h"

/* Clusters count as far from this many times their radius on. Sums are then off by up to 0.05, and
 * what is asked for is a side of 0.5; 3 would make it 0.02 and take twice as long or more. */
#define FAR 2.0

#define TWO_PI 6.283185307179586

enum { LEAF = 8, LEVELS_MAX = 30 };

typedef struct cluster {
    iso_vec3 middle;      /* by area */
    double reach_squared; /* distance of a point from which the cluster is far */
    iso_vec3 dipole;      /* sum of area times normal */
    double pole[6];       /* of offset times it: xx yy zz xy+yx yz+zy zx+xz */
} cluster;

struct iso_soup {
    int64_t count;
    int levels;       /* the root is level 0; leaves are at level `levels` */
    cluster *node;    /* [2^(levels + 1)]: root 1, children of i 2 i and 2 i + 1 */
    iso_vec3 *corner; /* [3 count] by the leaves */
};

static iso_vec3 subtract(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static double dot(iso_vec3 a, iso_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static iso_vec3 cross(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static void grow_box(iso_vec3 *min, iso_vec3 *max, iso_vec3 p) {
    *min = (iso_vec3){fmin(min->x, p.x), fmin(min->y, p.y), fmin(min->z, p.z)};
    *max = (iso_vec3){fmax(max->x, p.x), fmax(max->y, p.y), fmax(max->z, p.z)};
}

static int64_t first_of(const iso_soup *soup, int level, int64_t number) {
    return halves_first(soup->count, level, number);
}

/* By the nodes of the last level. */
static iso_status order(iso_soup *soup, const iso_vec3 *corner) {
    int32_t *from;
    ISO_TRY(ISO_ALLOCATE(from, soup->count));
    iso_status status = halves_order(from, corner, soup->count, soup->levels);
    for (int64_t i = 0; status == ISO_OK && i < soup->count; i++)
        memcpy(&soup->corner[3 * i], &corner[3 * (int64_t)from[i]], 3 * sizeof *corner);
    iso_release(from);
    return status;
}

/* Offset times dipole, both ways around. */
static void add_pole(double pole[6], iso_vec3 offset, iso_vec3 dipole) {
    pole[0] += offset.x * dipole.x;
    pole[1] += offset.y * dipole.y;
    pole[2] += offset.z * dipole.z;
    pole[3] += offset.x * dipole.y + offset.y * dipole.x;
    pole[4] += offset.y * dipole.z + offset.z * dipole.y;
    pole[5] += offset.z * dipole.x + offset.x * dipole.z;
}

typedef struct node_extent {
    iso_vec3 min, max;
    double area;
    double radius; /* of a ball around the cluster's middle that holds it */
} node_extent;

/* The ball that `radius` says, or the one around the box. */
static void set_reach(cluster *node, node_extent *extent, double radius) {
    iso_vec3 low = subtract(node->middle, extent->min), high = subtract(extent->max, node->middle);
    iso_vec3 far = {fmax(low.x, high.x), fmax(low.y, high.y), fmax(low.z, high.z)};
    extent->radius = fmin(radius, sqrt(dot(far, far)));
    node->reach_squared = FAR * FAR * extent->radius * extent->radius;
}

static double distance(iso_vec3 a, iso_vec3 b) {
    iso_vec3 way = subtract(a, b);
    return sqrt(dot(way, way));
}

static void make_leaf(cluster *node, node_extent *extent, const iso_vec3 *corner, int64_t count) {
    extent->min = (iso_vec3){INFINITY, INFINITY, INFINITY};
    extent->max = (iso_vec3){-INFINITY, -INFINITY, -INFINITY};
    extent->area = 0;
    *node = (cluster){0};
    iso_vec3 middle[LEAF], dipole[LEAF], sum = {0};
    for (int64_t i = 0; i < count; i++) {
        const iso_vec3 *a = &corner[3 * i];
        for (int k = 0; k < 3; k++)
            grow_box(&extent->min, &extent->max, a[k]);
        iso_vec3 n = cross(subtract(a[1], a[0]), subtract(a[2], a[0]));
        dipole[i] = (iso_vec3){n.x / 2, n.y / 2, n.z / 2};
        middle[i] = (iso_vec3){(a[0].x + a[1].x + a[2].x) / 3, (a[0].y + a[1].y + a[2].y) / 3,
                               (a[0].z + a[1].z + a[2].z) / 3};
        double area = sqrt(dot(dipole[i], dipole[i]));
        extent->area += area;
        sum = (iso_vec3){sum.x + area * middle[i].x, sum.y + area * middle[i].y,
                         sum.z + area * middle[i].z};
        node->dipole = (iso_vec3){node->dipole.x + dipole[i].x, node->dipole.y + dipole[i].y,
                                  node->dipole.z + dipole[i].z};
    }
    node->middle = extent->area > 0 ? (iso_vec3){sum.x / extent->area, sum.y / extent->area,
                                                 sum.z / extent->area}
                                    : extent->min;
    for (int64_t i = 0; i < count; i++)
        add_pole(node->pole, subtract(middle[i], node->middle), dipole[i]);
    double radius = 0;
    for (int64_t i = 0; i < 3 * count; i++)
        radius = fmax(radius, distance(corner[i], node->middle));
    set_reach(node, extent, radius);
}

static void make_parent(cluster *node, node_extent *extent, const cluster *child,
                        const node_extent *child_extent) {
    const node_extent *l = &child_extent[0], *r = &child_extent[1];
    *extent = *l;
    extent->area += r->area;
    grow_box(&extent->min, &extent->max, r->min);
    grow_box(&extent->min, &extent->max, r->max);
    double share = extent->area > 0 ? r->area / extent->area : 0.5;
    iso_vec3 way = subtract(child[1].middle, child[0].middle);
    *node = (cluster){
        .middle = {child[0].middle.x + share * way.x, child[0].middle.y + share * way.y,
                   child[0].middle.z + share * way.z},
        .dipole = {child[0].dipole.x + child[1].dipole.x, child[0].dipole.y + child[1].dipole.y,
                   child[0].dipole.z + child[1].dipole.z}};
    double radius = 0;
    for (int k = 0; k < 2; k++) {
        radius = fmax(radius, distance(child[k].middle, node->middle) + child_extent[k].radius);
        for (int j = 0; j < 6; j++)
            node->pole[j] += child[k].pole[j];
        add_pole(node->pole, subtract(child[k].middle, node->middle), child[k].dipole);
    }
    set_reach(node, extent, radius);
}

static iso_status make_nodes(iso_soup *soup) {
    int64_t leaves = (int64_t)1 << soup->levels;
    ISO_TRY(ISO_ALLOCATE(soup->node, 2 * leaves));
    node_extent *extents;
    ISO_TRY(ISO_ALLOCATE(extents, 2 * leaves));
    for (int64_t i = 0; i < leaves; i++) {
        int64_t first = first_of(soup, soup->levels, i);
        make_leaf(&soup->node[leaves + i], &extents[leaves + i], &soup->corner[3 * first],
                  first_of(soup, soup->levels, i + 1) - first);
    }
    for (int64_t i = leaves - 1; i > 0; i--)
        make_parent(&soup->node[i], &extents[i], &soup->node[2 * i], &extents[2 * i]);
    iso_release(extents);
    return ISO_OK;
}

iso_status soup_new(iso_soup **soup, const iso_vec3 *corner, int64_t count) {
    *soup = NULL;
    if (count > INT32_MAX)
        return iso_fail(ISO_UNSLICEABLE, "more than %d triangles in one object", INT32_MAX);
    iso_soup *made;
    ISO_TRY(ISO_ALLOCATE(made, 1));
    *made = (iso_soup){.count = count};
    while (made->levels < LEVELS_MAX && count > (int64_t)LEAF << made->levels)
        made->levels++;
    iso_status status = ISO_ALLOCATE(made->corner, 3 * count);
    if (status == ISO_OK && count > 0)
        status = order(made, corner);
    if (status == ISO_OK && count > 0)
        status = make_nodes(made);
    if (status != ISO_OK) {
        soup_free(made);
        return status;
    }
    *soup = made;
    return ISO_OK;
}

void soup_free(iso_soup *soup) {
    if (!soup)
        return;
    iso_release(soup->node);
    iso_release(soup->corner);
    iso_release(soup);
}

/* Half solid angles of triangles are angles of complex numbers (van Oosterom and Strackee, 1983):
 * multiplied, and the turns counted, they take one arctangent in the end. */
static double near_winding(const iso_vec3 *corner, int64_t count, iso_vec3 point) {
    double x = 1, y = 0;
    int turns = 0;
    for (int64_t i = 0; i < count; i++) {
        iso_vec3 a = subtract(corner[3 * i], point), b = subtract(corner[3 * i + 1], point);
        iso_vec3 c = subtract(corner[3 * i + 2], point);
        double la = sqrt(dot(a, a)), lb = sqrt(dot(b, b)), lc = sqrt(dot(c, c));
        double s = dot(a, cross(b, c));
        double t = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        double size = fmax(fabs(s), fabs(t));
        if (!(size > 0)) /* the point is on a corner */
            continue;
        s /= size;
        t /= size;
        double next_x = x * t - y * s, next_y = x * s + y * t;
        if ((y < 0) == (s < 0) && (next_y < 0) != (y < 0))
            turns += y < 0 ? -1 : 1;
        x = next_x;
        y = next_y;
    }
    return series_arctangent2(y, x) / TWO_PI + turns;
}

static double far_winding(const cluster *node, iso_vec3 d, double squared) {
    double near = 1 / (squared * sqrt(squared));
    const double *q = node->pole;
    double form = q[0] * d.x * d.x + q[1] * d.y * d.y + q[2] * d.z * d.z + q[3] * d.x * d.y +
                  q[4] * d.y * d.z + q[5] * d.z * d.x;
    return (dot(node->dipole, d) + q[0] + q[1] + q[2] - 3 * form / squared) * near / (2 * TWO_PI);
}

static double winding_of(const iso_soup *soup, iso_vec3 point) {
    int64_t waiting[LEVELS_MAX + 2];
    int count = 0;
    double sum = 0;
    waiting[count++] = 1;
    while (count > 0) {
        int64_t i = waiting[--count];
        const cluster *node = &soup->node[i];
        iso_vec3 d = subtract(node->middle, point);
        double squared = dot(d, d);
        if (squared > node->reach_squared) {
            sum += far_winding(node, d, squared);
        } else if (i >> soup->levels) {
            int64_t number = i - ((int64_t)1 << soup->levels);
            int64_t first = first_of(soup, soup->levels, number);
            sum += near_winding(&soup->corner[3 * first],
                                first_of(soup, soup->levels, number + 1) - first, point);
        } else {
            waiting[count++] = 2 * i + 1;
            waiting[count++] = 2 * i;
        }
    }
    return sum;
}

void soup_winding(double *winding, const iso_soup *soup, const iso_vec3 *point, int64_t count) {
    for (int64_t i = 0; i < count; i++)
        winding[i] = soup->count > 0 ? winding_of(soup, point[i]) : 0;
}

iso_status soup_inside(void *soup, uint8_t *inside, const iso_vec3 *point, int64_t count) {
    const iso_soup *of = soup;
    for (int64_t i = 0; i < count; i++)
        inside[i] = of->count > 0 && winding_of(of, point[i]) > 0.5;
    return ISO_OK;
}
