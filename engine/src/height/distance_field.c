/* Signed distance to a second surface: exact for its triangles, by a tree of them.
 *
 * A grid of samples with a smooth interpolation was the alternative. It would be faster still, but
 * its layers would show the grid, and none is fine enough for the corners of a small part and
 * coarse enough for the box of a large one; next to what is done with a point of a layer, the
 * microseconds of the tree are few.
 *
 * Which side a point is on follows from the normal of the corner, edge or triangle that is nearest,
 * by J. A. Baerentzen and H. Aanaes, Signed distance computation using the angle weighted
 * pseudonormal, 2005. */
#include <math.h>
#include <stddef.h>

#include "base/memory.h"
#include "base/series.h"
#include "base/vector.h"
#include "field/field.h"
#include "height/fields.h"
#include "height/surface.h"
#include "solid/volume.h"

/* mm: nearer points have no direction to speak of, and take the surface's. */
#define NOWHERE 1e-9

typedef struct distance_field {
    iso_field field;
    surface surface;
    iso_vec3 *face;   /* [triangle_count] unit, outward; zero of triangles without area */
    iso_vec3 *edge;   /* [3 triangle_count] by dart */
    iso_vec3 *corner; /* [vertex_count] */
} distance_field;

/* Of whatever has the nearest point. */
static iso_vec3 normal_at(const distance_field *d, const foot *f) {
    int least = 3, nothing = 0, most = 0;
    for (int k = 0; k < 3; k++) {
        if (f->share[k] > 0) {
            most = f->share[k] > f->share[most] ? k : most;
        } else {
            least = k;
            nothing++;
        }
    }
    if (nothing == 0)
        return d->face[f->triangle];
    if (nothing == 1)
        return d->edge[3 * f->triangle + (least + 1) % 3];
    return d->corner[d->surface.origin[3 * f->triangle + most]];
}

/* Distance, and its gradient. */
static double distance_to(iso_vec3 *gradient, const distance_field *d, const foot *f, iso_vec3 p) {
    iso_vec3 normal = normal_at(d, f), way = vec3_minus(p, f->point);
    double length = vec3_length(way), sign = vec3_dot(way, normal) < 0 ? -1 : 1;
    *gradient = length > NOWHERE ? vec3_times(way, sign / length) : normal;
    return sign * length;
}

static void evaluate(double *value, iso_vec3 *gradient, const iso_field *field, const iso_vec3 *at,
                     int64_t count) {
    const distance_field *d = (const distance_field *)field;
    int32_t guess = 0;
    for (int64_t i = 0; i < count; i++) {
        foot f;
        iso_vec3 slope;
        surface_nearest(&f, &d->surface, at[i], &guess);
        value[i] = distance_to(&slope, d, &f, at[i]);
        if (gradient)
            gradient[i] = slope;
    }
}

// Bounds

static void widen_by(iso_field_bound *b, iso_vec3 g, double spread) {
    b->gradient_low.x = fmin(b->gradient_low.x, fmax(g.x - spread, -1));
    b->gradient_low.y = fmin(b->gradient_low.y, fmax(g.y - spread, -1));
    b->gradient_low.z = fmin(b->gradient_low.z, fmax(g.z - spread, -1));
    b->gradient_high.x = fmax(b->gradient_high.x, fmin(g.x + spread, 1));
    b->gradient_high.y = fmax(b->gradient_high.y, fmin(g.y + spread, 1));
    b->gradient_high.z = fmax(b->gradient_high.z, fmin(g.z + spread, 1));
}

/* Has every point within `radius` of the one whose foot it is its foot inside the triangle? */
static int stays_within(const surface *s, const foot *f, double radius) {
    iso_vec3 normal = surface_area(s, f->triangle);
    double area = vec3_length(normal);
    for (int k = 0; k < 3; k++) {
        const int32_t *v = s->origin + 3 * f->triangle;
        double side = vec3_distance(s->position[v[(k + 1) % 3]], s->position[v[(k + 2) % 3]]);
        if (!(f->share[k] * area > radius * side))
            return 0;
    }
    return 1;
}

/* A triangle's own distance is convex, so it is nowhere in the box below what its slope says; and
 * that of the nearest one bends by no more than 1 / distance. Is the triangle always beaten? */
static int never_nearest(const surface_box *box, iso_vec3 way, double far) {
    double least = box->distance - box->radius;
    if (!(least > 0))
        return 0;
    iso_vec3 nearest = vec3_times(vec3_minus(box->middle, box->nearest.point), 1 / box->distance);
    double apart = vec3_distance(nearest, vec3_times(way, 1 / far));
    double rise = apart * box->radius + box->radius * box->radius / (2 * least);
    return far - box->distance > rise + 1e-9 * far;
}

/* The way from the nearest point of a convex set turns and grows by no more than the point moves,
 * so a triangle that is `far` away has directions within a cone of sine radius / far. */
static void add_candidate(iso_field_bound *b, const distance_field *d, int32_t triangle,
                          const surface_box *box, double sign) {
    foot f;
    surface_nearest_of(&f, &d->surface, triangle, box->middle);
    iso_vec3 way = vec3_minus(box->middle, f.point);
    double far = vec3_length(way), sine = box->radius / far;
    if (never_nearest(box, way, far))
        return;
    if (stays_within(&d->surface, &f, box->radius))
        widen_by(b, d->face[triangle], 1e-9);
    else if (box->distance > box->radius && sine < 1)
        widen_by(b, vec3_times(way, sign / far), sqrt(2 - 2 * sqrt(1 - sine * sine)) + 1e-9);
    else
        widen_by(b, vec3(0, 0, 0), 1);
}

static void bound(iso_field_bound *b, const iso_field *field, iso_vec3 low, iso_vec3 high) {
    const distance_field *d = (const distance_field *)field;
    int32_t triangle[SURFACE_MOST];
    surface_box box;
    iso_vec3 slope;
    int count = surface_candidates(triangle, &box, &d->surface, low, high);
    double middle = distance_to(&slope, d, &box.nearest, box.middle);
    b->gradient_low = vec3(1, 1, 1);
    b->gradient_high = vec3(-1, -1, -1);
    if (count > SURFACE_MOST || count == 0)
        widen_by(b, vec3(0, 0, 0), 1);
    for (int i = 0; i < count && count <= SURFACE_MOST; i++)
        add_candidate(b, d, triangle[i], &box, middle < 0 ? -1 : 1);
    double rise = (high.x - low.x) / 2 * fmax(-b->gradient_low.x, b->gradient_high.x) +
                  (high.y - low.y) / 2 * fmax(-b->gradient_low.y, b->gradient_high.y) +
                  (high.z - low.z) / 2 * fmax(-b->gradient_low.z, b->gradient_high.z);
    double reach = fmin(box.radius, rise) + 1e-12 * (1 + box.distance + box.radius);
    b->low = middle - reach;
    b->high = middle + reach;
}

// Making one

static void release(iso_field *field) {
    distance_field *d = (distance_field *)field;
    surface_free(&d->surface);
    iso_release(d->face);
    iso_release(d->edge);
    iso_release(d->corner);
    iso_release(d);
}

static const field_operations operations = {ISO_FIELD_DISTANCE, evaluate, bound, release};

/* Angle of a triangle at the origin of a dart. */
static double angle_at(const surface *s, int32_t dart) {
    iso_vec3 at = s->position[s->origin[dart]];
    iso_vec3 a = vec3_minus(s->position[s->origin[iso_mesh_alpha(dart)]], at);
    iso_vec3 b = vec3_minus(s->position[s->origin[iso_mesh_alpha_inverse(dart)]], at);
    return series_arctangent2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b));
}

static iso_status find_normals(distance_field *d, const int32_t *opposite) {
    const surface *s = &d->surface;
    int32_t darts = 3 * s->triangle_count;
    ISO_TRY(ISO_ALLOCATE(d->face, s->triangle_count));
    ISO_TRY(ISO_ALLOCATE(d->edge, darts));
    ISO_TRY(ISO_ALLOCATE(d->corner, s->vertex_count));
    for (int32_t v = 0; v < s->vertex_count; v++)
        d->corner[v] = vec3(0, 0, 0);
    for (int32_t t = 0; t < s->triangle_count; t++)
        d->face[t] = vec3_unit(surface_area(s, t));
    for (int32_t a = 0; a < darts; a++) {
        iso_vec3 *corner = &d->corner[s->origin[a]];
        *corner = vec3_along(*corner, angle_at(s, a), d->face[a / 3]);
        d->edge[a] = vec3_unit(vec3_plus(d->face[a / 3], d->face[opposite[a] / 3]));
    }
    for (int32_t v = 0; v < s->vertex_count; v++)
        d->corner[v] = vec3_unit(d->corner[v]);
    return ISO_OK;
}

iso_status height_new_distance_to(iso_field **field, const iso_mesh *mesh, iso_vec3 origin) {
    *field = NULL;
    if (mesh->triangle_count == 0)
        return iso_fail(ISO_UNREADABLE, "a surface without triangles has no distance");
    distance_field *d;
    ISO_TRY(ISO_ALLOCATE(d, 1));
    *d = (distance_field){.field = {&operations}};
    iso_status status = surface_new(&d->surface, mesh, 1, origin);
    if (status == ISO_OK)
        status = find_normals(d, mesh->opposite);
    if (status != ISO_OK) {
        release(&d->field);
        return status;
    }
    *field = &d->field;
    return ISO_OK;
}

/* mm: OpenVDB may round otherwise on another processor. */
#define GRAIN 0x1p-12

static double rounded(double x) {
    double grains = x / GRAIN;
    return (grains < 0 ? -(double)(int64_t)(0.5 - grains) : (double)(int64_t)(grains + 0.5)) *
           GRAIN;
}

/* The surface where a grid is 0, or between on and off, as a mesh: grids know distances but beside
 * it. */
static iso_status read_grid(iso_mesh *mesh, const char *path) {
    iso_volume *volume;
    float *triangle = NULL;
    int64_t count = 0;
    ISO_TRY(volume_read(&volume, path, NULL));
    iso_status status = volume_surface(&triangle, &count, volume, 0);
    volume_free(volume);
    if (status == ISO_OK) {
        for (int64_t i = 0; i < 9 * count; i++)
            triangle[i] = (float)rounded((double)triangle[i]);
        status = iso_mesh_from_triangles(mesh, triangle, count);
    }
    iso_release(triangle);
    return status;
}

static int is_grid(const char *path) {
    size_t length = strlen(path);
    return length >= 4 && strcmp(path + length - 4, ".vdb") == 0;
}

iso_status height_new_distance(iso_field **field, const char *path, iso_vec3 origin) {
    iso_mesh mesh;
    *field = NULL;
    ISO_TRY(is_grid(path) ? read_grid(&mesh, path) : iso_mesh_read(&mesh, path));
    iso_status status = height_new_distance_to(field, &mesh, origin);
    iso_mesh_free(&mesh);
    return status;
}
