#include <isoslice/object.h>

#include <math.h>

#include "base/angle.h"
#include "mesh/builder.h"
#include "object/transform.h"

/* A linear map about a point that stays where it is. */
typedef struct map {
    double row[3][3];
    iso_vec3 middle;
} map;

static double cell(const map *m, int i, double x, double y, double z) {
    return m->row[i][0] * x + m->row[i][1] * y + m->row[i][2] * z;
}

/* Zeros and ones add nothing but exact zeros, so quarter turns and mirrors round nothing away. */
static iso_vec3 apply(const map *m, iso_vec3 p) {
    double x = p.x - m->middle.x, y = p.y - m->middle.y, z = p.z - m->middle.z;
    return (iso_vec3){m->middle.x + cell(m, 0, x, y, z), m->middle.y + cell(m, 1, x, y, z),
                      m->middle.z + cell(m, 2, x, y, z)};
}

/* Turn what the map gives about an axis: the two rows of the others mix. */
static void turn(map *m, int axis, double degrees) {
    int a = (axis + 1) % 3, b = (axis + 2) % 3;
    double s, c;
    iso_sine_cosine(&s, &c, degrees);
    for (int k = 0; k < 3; k++) {
        double u = m->row[a][k], v = m->row[b][k];
        m->row[a][k] = c * u - s * v;
        m->row[b][k] = s * u + c * v;
    }
}

typedef struct extent {
    iso_vec3 min, max;
} extent;

static void extend(extent *e, iso_vec3 p) {
    e->min = (iso_vec3){fmin(e->min.x, p.x), fmin(e->min.y, p.y), fmin(e->min.z, p.z)};
    e->max = (iso_vec3){fmax(e->max.x, p.x), fmax(e->max.y, p.y), fmax(e->max.z, p.z)};
}

static const extent nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static extent extent_of(const iso_mesh *mesh, int32_t count) {
    extent e = nothing;
    for (int32_t i = 0; i < count; i++)
        if (mesh[i].triangle_count > 0) {
            extend(&e, mesh[i].min);
            extend(&e, mesh[i].max);
        }
    return e;
}

/* Vertices that no dart uses don't count. */
static extent mapped_extent(const iso_mesh *mesh, int32_t count, const map *m) {
    extent e = nothing;
    for (int32_t i = 0; i < count; i++)
        for (int64_t a = 0; a < 3 * (int64_t)mesh[i].triangle_count; a++)
            extend(&e, apply(m, mesh[i].position[mesh[i].origin[a]]));
    return e;
}

static void scale(map *m, double factor) {
    for (int i = 0; i < 9; i++)
        m->row[i / 3][i % 3] *= factor;
}

static double fitting_factor(const extent *e, iso_vec3 fit) {
    const double limit[3] = {fit.x, fit.y, fit.z};
    const double size[3] = {e->max.x - e->min.x, e->max.y - e->min.y, e->max.z - e->min.z};
    double factor = INFINITY;
    for (int i = 0; i < 3; i++)
        if (limit[i] > 0 && size[i] > 0)
            factor = fmin(factor, limit[i] / size[i]);
    return factor < INFINITY ? factor : 1;
}

/* Dart 3t + k runs the other way as dart 3t + 2 - k. */
static void turn_triangles(iso_mesh *mesh) {
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        int32_t *v = mesh->origin + 3 * t, *o = mesh->opposite + 3 * t, swap;
        swap = v[1], v[1] = v[2], v[2] = swap;
        swap = o[0], o[0] = o[2], o[2] = swap;
        for (int k = 0; k < 3; k++)
            o[k] = 3 * (o[k] / 3) + 2 - o[k] % 3;
    }
}

static void transform_mesh(iso_mesh *mesh, const map *m, bool mirrored) {
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        mesh->position[v] = apply(m, mesh->position[v]);
    extent e = nothing;
    for (int64_t a = 0; a < 3 * (int64_t)mesh->triangle_count; a++)
        extend(&e, mesh->position[mesh->origin[a]]);
    if (mesh->triangle_count > 0)
        mesh->min = e.min, mesh->max = e.max;
    if (mirrored)
        turn_triangles(mesh);
}

static bool is_finite(double value) {
    return value - value == 0;
}

static iso_status check_transform(const iso_transform *t) {
    if (!is_finite(t->scale) || t->scale < 0)
        return iso_fail(ISO_USAGE, "a model can't be scaled by %g; see scale", t->scale);
    if (!is_finite(t->rotate[0]) || !is_finite(t->rotate[1]) || !is_finite(t->rotate[2]))
        return iso_fail(ISO_USAGE, "a model can't be turned by an angle that isn't finite");
    if (!(t->fit.x >= 0 && t->fit.y >= 0 && t->fit.z >= 0) || !is_finite(t->fit.x) ||
        !is_finite(t->fit.y) || !is_finite(t->fit.z))
        return iso_fail(ISO_USAGE, "a model can't be fitted into %g x %g x %g mm; see scale_to_fit",
                        t->fit.x, t->fit.y, t->fit.z);
    return ISO_OK;
}

static bool does_nothing(const iso_transform *t) {
    return !t->inches && (t->scale == 0 || t->scale == 1) && t->fit.x == 0 && t->fit.y == 0 &&
           t->fit.z == 0 && !t->mirror[0] && !t->mirror[1] && !t->mirror[2] && t->rotate[0] == 0 &&
           t->rotate[1] == 0 && t->rotate[2] == 0;
}

static map map_of(const iso_transform *t, const extent *e) {
    map m = {.middle = {(e->min.x + e->max.x) / 2, (e->min.y + e->max.y) / 2,
                        (e->min.z + e->max.z) / 2}};
    for (int i = 0; i < 3; i++)
        m.row[i][i] = (t->mirror[i] ? -1.0 : 1.0) * (t->scale > 0 ? t->scale : 1);
    if (t->inches)
        scale(&m, 25.4);
    for (int axis = 0; axis < 3; axis++)
        if (t->rotate[axis] != 0)
            turn(&m, axis, t->rotate[axis]);
    return m;
}

iso_status iso_meshes_transform(iso_mesh *mesh, int32_t count, const iso_transform *transform) {
    return meshes_transform_along(mesh, count, count, transform);
}

iso_status meshes_transform_along(iso_mesh *mesh, int32_t count, int32_t leading,
                                  const iso_transform *transform) {
    ISO_TRY(check_transform(transform));
    extent e = extent_of(mesh, leading);
    if (does_nothing(transform) || e.min.x > e.max.x)
        return ISO_OK;
    map m = map_of(transform, &e);
    if (transform->fit.x > 0 || transform->fit.y > 0 || transform->fit.z > 0) {
        extent whole = mapped_extent(mesh, leading, &m);
        scale(&m, fitting_factor(&whole, transform->fit));
    }
    extent reached = mapped_extent(mesh, count, &m);
    const double far = ISO_MESH_COORDINATE_MAX;
    if (!(reached.min.x >= -far && reached.min.y >= -far && reached.min.z >= -far &&
          reached.max.x <= far && reached.max.y <= far && reached.max.z <= far))
        return iso_fail(ISO_OUTSIDE, "the model reaches beyond 10 km; see scale and inches");
    bool mirrored = transform->mirror[0] ^ transform->mirror[1] ^ transform->mirror[2];
    for (int32_t i = 0; i < count; i++)
        transform_mesh(&mesh[i], &m, mirrored);
    return ISO_OK;
}
