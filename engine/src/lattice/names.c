#include <isoslice/lattice.h>

#include <stddef.h>

static const char *const names[ISO_LATTICE_COUNT] = {
    [ISO_LATTICE_GYROID_SHEET] = "gyroid_sheet",
    [ISO_LATTICE_GYROID_SOLID] = "gyroid_solid",
    [ISO_LATTICE_PRIMITIVE_SHEET] = "primitive_sheet",
    [ISO_LATTICE_PRIMITIVE_SOLID] = "primitive_solid",
    [ISO_LATTICE_DIAMOND_SHEET] = "diamond_sheet",
    [ISO_LATTICE_DIAMOND_SOLID] = "diamond_solid",
    [ISO_LATTICE_IWP_SHEET] = "iwp_sheet",
    [ISO_LATTICE_IWP_SOLID] = "iwp_solid",
    [ISO_LATTICE_NEOVIUS_SHEET] = "neovius_sheet",
    [ISO_LATTICE_NEOVIUS_SOLID] = "neovius_solid",
    [ISO_LATTICE_FISCHER_KOCH_SHEET] = "fischer_koch_sheet",
    [ISO_LATTICE_FISCHER_KOCH_SOLID] = "fischer_koch_solid",
    [ISO_LATTICE_BCC_STRUTS] = "bcc_struts",
    [ISO_LATTICE_FCC_STRUTS] = "fcc_struts",
    [ISO_LATTICE_OCTET_STRUTS] = "octet_struts",
    [ISO_LATTICE_KELVIN_STRUTS] = "kelvin_struts",
    [ISO_LATTICE_DIAMOND_STRUTS] = "diamond_struts",
    [ISO_LATTICE_FOAM_STRUTS] = "foam_struts",
    [ISO_LATTICE_FOAM_SHEET] = "foam_sheet",
    [ISO_LATTICE_BONE_SHEET] = "bone_sheet",
    [ISO_LATTICE_BONE_SOLID] = "bone_solid",
    [ISO_LATTICE_VOXEL_CUBIC] = "voxel_cubic",
    [ISO_LATTICE_VOXEL_RANDOM] = "voxel_random",
    [ISO_LATTICE_VOXEL_FILE] = "voxel_file",
};

const char *iso_lattice_name(int32_t pattern) {
    return pattern >= 0 && pattern < ISO_LATTICE_COUNT ? names[pattern] : NULL;
}

iso_lattice_options iso_lattice_defaults(void) {
    return (iso_lattice_options){.pattern = ISO_LATTICE_GYROID_SHEET,
                                 .map = ISO_LATTICE_MAP_XYZ,
                                 .cell = "5",
                                 .density = "20",
                                 .pore = 0.4,
                                 .file = "",
                                 .grid = ""};
}
