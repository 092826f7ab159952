/* Channels of the distance on the triangles: there are no towers, contours of the mesh are the
 * rings. */
#include "channel/lead.h"
#include "channel/split.h"
#include "height/height.h"

/* Of the pitch: edges are no longer than that. Distances are exact at vertices, and between them
 * they are taken as straight. */
#define EDGE_SHARE 0.25

/* From the lowest vertices; parts of the mesh that they have no way to are below all levels. */
static iso_status find_distances(double *distance, double *most, const iso_mesh *mesh) {
    double low = mesh->min.z + 1e-6 * (mesh->max.z - mesh->min.z);
    int32_t *source, count = 0;
    ISO_TRY(ISO_ALLOCATE(source, mesh->vertex_count));
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        if (mesh->position[v].z <= low)
            source[count++] = v;
    iso_status status = height_geodesic(distance, mesh, source, count);
    iso_release(source);
    ISO_TRY(status);
    *most = 0;
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        distance[v] = isfinite(distance[v]) ? distance[v] : -1;
        *most = distance[v] > *most ? distance[v] : *most;
    }
    return ISO_OK;
}

/* Around a top the last ring may be as narrow as can be. */
static iso_status find_narrow(bool *narrow, const iso_channels *c, const curve *pushed) {
    curve tried;
    int32_t at;
    ISO_TRY(curve_resample(&tried, pushed, c->bend / STEPS_A_BEND));
    iso_status status = curve_relax(&tried, c->bend, c->bend / STEPS_A_BEND, 0);
    if (status == ISO_OK)
        *narrow = curve_least_radius(&at, &tried) < c->bend;
    curve_free(&tried);
    return status;
}

static iso_status add_contour(iso_channels *c, const contours *all, int32_t at, int32_t number,
                              series *s) {
    double f = all->level[all->at[at]];
    ring outline;
    curve pushed;
    bool narrow = false;
    ISO_TRY(ring_of_contour(&outline, all, at, &c->fine, &c->arena));
    ISO_TRY(lead_off(&pushed, c, &outline));
    iso_status status = all->next[at] < 0 ? find_narrow(&narrow, c, &pushed) : ISO_OK;
    c->figures.narrow += narrow;
    if (status == ISO_OK && !narrow)
        status = lead_note(c, number, f, &outline);
    if (status == ISO_OK && !narrow)
        status = c->options.ports == ISO_CHANNEL_SERIES ? lead_on(c, s, NULL, f, &pushed)
                                                        : lead_ring(c, &pushed);
    curve_free(&pushed);
    return status;
}

/* Contours on top of each other, from one that is on none or on several. */
static iso_status add_chain(iso_channels *c, const contours *all, int32_t first, int32_t number) {
    series s = {0};
    iso_status status = ISO_OK;
    for (int32_t at = first; at >= 0 && status == ISO_OK; at = all->next[at])
        status = add_contour(c, all, at, number, &s);
    if (status == ISO_OK && s.rings > 0)
        status = lead_to_ports(c, &s.way);
    curve_free(&s.way);
    return status;
}

static iso_status add_chains(iso_channels *c, const contours *all) {
    uint8_t *has_below;
    int32_t number = 0;
    ISO_TRY(ISO_PUSH(has_below, &c->arena, all->count));
    for (int32_t i = 0; i < all->count; i++)
        has_below[i] = 0;
    for (int32_t i = 0; i < all->count; i++)
        if (all->next[i] >= 0)
            has_below[all->next[i]] = 1;
    for (int32_t i = 0; i < all->count; i++) {
        if (has_below[i] || (all->area[i] < 0 && !c->options.holes))
            continue;
        channels_report(c, 0.3 + 0.3 * i / all->count, "channels");
        ISO_TRY(add_chain(c, all, i, number++));
    }
    return ISO_OK;
}

iso_status lead_geodesics(iso_channels *c) {
    contours all = {0};
    double *distance, most;
    ISO_TRY(mesh_split(&c->fine, c->mesh, EDGE_SHARE * c->options.pitch));
    ISO_TRY(ISO_PUSH(distance, &c->arena, c->fine.vertex_count));
    ISO_TRY(find_distances(distance, &most, &c->fine));
    double levels = floor((most - c->start) / c->options.pitch) + 1;
    if (!(levels >= 1))
        return ISO_OK;
    all.level_count = levels < LEVELS_MOST ? (int32_t)levels : LEVELS_MOST;
    ISO_TRY(ISO_PUSH(all.level, &c->arena, all.level_count));
    for (int32_t k = 0; k < all.level_count; k++)
        all.level[k] = c->start + c->options.pitch * k;
    ISO_TRY(contours_cut(&all, &c->fine, distance, &c->arena));
    return add_chains(c, &all);
}
