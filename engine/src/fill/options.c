#include <isoslice/fill.h>

#include <math.h>

enum { LINK_SPACINGS = 5, DEVIATION = 100 };

iso_fill_options iso_fill_defaults(iso_bead bead, double density) {
    int solid = density >= 1;
    double spacing = solid ? bead.spacing : bead.spacing / density;
    double link = spacing * LINK_SPACINGS;
    return (iso_fill_options){
        .spacing = spacing,
        .fit = solid,
        .density = solid ? 1 : density,
        .width = bead.width,
        .area = bead.area,
        .margin = (int32_t)(spacing / 2),
        .link_max = link < ISO_COORDINATE_MAX ? (int32_t)link : ISO_COORDINATE_MAX,
        .deviation = DEVIATION,
        .shortest = bead.width / 2,
        .like = {.role = solid ? ISO_ROLE_SOLID_INFILL : ISO_ROLE_INTERNAL_INFILL},
    };
}

iso_status iso_fill_options_validate(const iso_fill_options *options) {
    if (!(options->spacing >= ISO_FILL_SPACING_MIN && options->spacing <= 4.0 * ISO_COORDINATE_MAX))
        return iso_fail(ISO_USAGE, "fill: a spacing of %g mm is out of range (%g to %g mm)",
                        options->spacing / ISO_UNITS_PER_MM, iso_mm(ISO_FILL_SPACING_MIN),
                        iso_mm(4 * ISO_COORDINATE_MAX));
    if (options->width < 0 || options->width > ISO_COORDINATE_MAX || options->area < 0 ||
        options->area > 1 << 30)
        return iso_fail(ISO_USAGE, "fill: a bead %d units wide with an area of %d is out of range",
                        options->width, options->area);
    if (!(fabs(options->angle) <= 1e6))
        return iso_fail(ISO_USAGE, "fill: an angle of %g degrees is out of range", options->angle);
    if (!(fabs(options->phase) <= 4.0 * ISO_COORDINATE_MAX))
        return iso_fail(ISO_USAGE, "fill: a phase of %g mm is out of range",
                        options->phase / ISO_UNITS_PER_MM);
    return ISO_OK;
}
