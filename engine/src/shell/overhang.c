#include <isoslice/shell.h>

iso_status iso_walls_find_overhangs(iso_paths *paths, const iso_region *support,
                                    const iso_overhang_options *options,
                                    iso_planar_scratch *scratch) {
    return ISO_OK;
}
