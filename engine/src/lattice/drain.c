#include "lattice/drain.h"

#include "base/angle.h"

/* A hole of 3 mm is then within 2 um of a circle. */
enum { CORNERS = 96 };

static iso_status add_hole(iso_region *holes, double x, double y, double radius) {
    iso_point corner[CORNERS];
    for (int i = 0; i < CORNERS; i++) {
        double sine, cosine;
        iso_sine_cosine(&sine, &cosine, i * (360.0 / CORNERS));
        corner[i] = (iso_point){iso_units(x + radius * cosine), iso_units(y + radius * sine)};
    }
    return iso_region_add(holes, corner, CORNERS);
}

iso_status drains_cut(iso_region *outline, iso_region *const spare[2], const iso_drains *drains,
                      iso_planar_scratch *scratch) {
    iso_region *holes = spare[0], *rest = spare[1];
    iso_region_clear(holes);
    for (int32_t i = 0; i < drains->count; i++)
        ISO_TRY(add_hole(holes, drains->at[2 * i], drains->at[2 * i + 1], drains->radius));
    ISO_TRY(iso_boolean(rest, ISO_DIFFERENCE, outline, holes, scratch));
    iso_region swap = *outline;
    *outline = *rest;
    *rest = swap;
    return ISO_OK;
}
