#include "surround.h"

#include <string.h>

#include <isoslice/skirt.h>

#include "plate.h"

static const double pi = 3.14159265358979323846;

static iso_bead bead_of(const iso_options *options, bool first, double height) {
    double width = iso_options_width(options, ISO_ROLE_SKIRT, first, height);
    return iso_bead_of(iso_units(width), iso_units(height));
}

static int32_t brim_loops(const iso_options *options, const iso_bead *bead) {
    if (options->brim_type == ISO_BRIM_NONE)
        return 0;
    return iso_units(options->brim_width) / bead->spacing;
}

/* Units of bead that take so many mm of filament. */
static double bead_of_filament(const iso_options *options, const iso_bead *bead, double mm) {
    double d = options->filament_diameter * ISO_UNITS_PER_MM;
    return mm * ISO_UNITS_PER_MM * pi / 4 * d * d / bead->area;
}

/* The skirt keeps its distance from the brim, a draft shield from the parts. */
static iso_status add_skirt(iso_surround *surround, const iso_region *around,
                            const iso_options *options, const iso_bead *bead, int32_t brim,
                            iso_planar_scratch *scratch) {
    iso_skirt_options skirt = {.loops = options->skirts, .bead = *bead};
    skirt.distance = iso_units(options->skirt_distance) + bead->width / 2;
    if (options->draft_shield == ISO_SHIELD_DISABLED && brim > 0)
        skirt.distance += iso_units(options->brim_separation) + brim * bead->spacing;
    if (options->skirts > 0)
        skirt.min_length = bead_of_filament(options, bead, options->min_skirt_length);
    ISO_TRY(iso_skirt(&surround->paths, around, &skirt, scratch));
    surround->skirt_paths = surround->paths.count;
    surround->layers = options->skirt_height;
    if (options->draft_shield == ISO_SHIELD_ENABLED)
        surround->layers = INT32_MAX;
    return ISO_OK;
}

static iso_status add_brim(iso_surround *surround, const iso_region *first,
                           const iso_options *options, const iso_bead *bead, int32_t loops,
                           iso_planar_scratch *scratch) {
    iso_brim_options brim = {.loops = loops, .bead = *bead, .rank = surround->skirt_paths};
    brim.distance = iso_units(options->brim_separation) + bead->width / 2;
    brim.outer = options->brim_type != ISO_BRIM_INNER;
    brim.inner = options->brim_type != ISO_BRIM_OUTER;
    iso_region clean = {0};
    iso_status status = iso_region_clean(&clean, first, ISO_FILL_NONZERO, scratch);
    if (status == ISO_OK)
        status = iso_brim(&surround->paths, &clean, &brim, scratch);
    iso_region_free(&clean);
    return status;
}

/* Models lie on the bed; what is drawn around them need not. */
static iso_status check_bed(const iso_surround *surround, const iso_options *options) {
    const iso_paths *paths = &surround->paths;
    for (int32_t i = 0; i < paths->count; i++)
        for (int32_t v = 0; v < paths->path[i].count; v++) {
            iso_point at = paths->vertex[paths->path[i].first + v].at;
            if (plate_on_bed(&options->bed_shape, iso_mm(at.x), iso_mm(at.y)))
                continue;
            return iso_fail(ISO_OUTSIDE, "the %s reaches beyond the bed at (%.2f, %.2f); see %s",
                            i < surround->skirt_paths ? "skirt" : "brim", iso_mm(at.x),
                            iso_mm(at.y),
                            i < surround->skirt_paths ? "skirts and skirt_distance" : "brim_width");
        }
    return ISO_OK;
}

iso_status surround_make(iso_surround *surround, const iso_region *first, const iso_region *all,
                         const iso_options *options, iso_planar_scratch *scratch) {
    iso_bead bead = bead_of(options, true, iso_options_first_height(options));
    int32_t loops = brim_loops(options, &bead);
    bool tall = options->skirt_height > 1 || options->draft_shield == ISO_SHIELD_ENABLED;
    ISO_TRY(add_skirt(surround, tall ? all : first, options, &bead, loops, scratch));
    if (loops > 0)
        ISO_TRY(add_brim(surround, first, options, &bead, loops, scratch));
    return check_bed(surround, options);
}

void surround_free(iso_surround *surround) {
    iso_paths_free(&surround->paths);
    iso_paths_free(&surround->higher);
}

static iso_status copy_skirt(iso_surround *surround) {
    iso_paths skirt = surround->paths;
    skirt.count = surround->skirt_paths;
    skirt.vertex_count = 0;
    for (int32_t i = 0; i < skirt.count; i++)
        skirt.vertex_count += skirt.path[i].count;
    iso_paths_clear(&surround->higher);
    return iso_paths_append(&surround->higher, &skirt, (iso_point){0, 0}, -1);
}

iso_status surround_step(const iso_paths **paths, iso_surround *surround, int32_t z, int32_t height,
                         const iso_options *options) {
    int32_t missing = z - surround->top, index = surround->drawn;
    *paths = NULL;
    if (2 * (int64_t)missing < height)
        return ISO_OK;
    surround->drawn++;
    surround->top = z;
    if (index == 0 && surround->paths.count > 0)
        *paths = &surround->paths;
    if (index == 0 || index >= surround->layers || surround->skirt_paths == 0)
        return ISO_OK;
    iso_bead bead = bead_of(options, false, iso_mm(missing));
    if (surround->higher.count == 0)
        ISO_TRY(copy_skirt(surround));
    for (int32_t v = 0; v < surround->higher.vertex_count; v++) {
        surround->higher.vertex[v].width = bead.width;
        surround->higher.vertex[v].area = bead.area;
    }
    *paths = &surround->higher;
    return ISO_OK;
}
