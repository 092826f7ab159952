/* Bytes as a text with macros: what evaluates has the right form, and gives the same again. */
#include "fuzz.h"

#include <string.h>

#include "config/foreign.h"
#include "macro/macro.h"

static char out[1 << 16], again[1 << 16], text[1 << 15];

static iso_status expand(char *to, const iso_options *options) {
    static const iso_macro_job job = {.input_filename = "a/b.stl",
                                      .timestamp = 1795319958,
                                      .object_count = 1,
                                      .instance_count = 1,
                                      .layer_count = 9,
                                      .print_max = {10, 20}};
    static const iso_macro_number number[] = {{"layer_num", 3, true}, {"layer_z", 1.25, false}};
    iso_macro_globals globals = {0};
    const iso_macro_scope scope = {options, &job, number, 2, &globals};
    iso_status status = iso_macro_expand(to, sizeof out, text, "start_gcode", &scope);
    if (status == ISO_OK) /* globals that were left behind */
        status = iso_macro_expand(to, sizeof out, text, "start_gcode", &scope);
    iso_macro_globals_free(&globals);
    return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    static iso_options options;
    if (options.perimeters == 0)
        iso_options_defaults(&options);
    if (size >= sizeof text)
        return 0;
    memcpy(text, bytes, size);
    text[size] = 0;
    /* the bytes as the value of a key, too: lists, quotes, percent */
    memset(&options.foreign, 0, sizeof options.foreign);
    (void)iso_foreign_set(&options.foreign, "filament_notes", text);
    (void)iso_foreign_set(&options.foreign, "support_material_xy_spacing", text);
    (void)iso_foreign_set(&options.foreign, "thumbnails", text);
    (void)iso_foreign_set(&options.foreign, "unheard_of", text);
    iso_status status = expand(out, &options);
    if (status != ISO_OK && status != ISO_BAD_CONFIG)
        fuzz_right(status);
    if (expand(again, &options) != status || (status == ISO_OK && strcmp(out, again) != 0))
        abort();
    if (status == ISO_OK)
        fuzz_right(iso_macro_check(text, "start_gcode"));
    strcpy(text, "{filament_notes[0]}[filament_notes_1]{size(thumbnails)}{unheard_of}"
                 "{support_material_xy_spacing}");
    status = expand(out, &options);
    if (status != ISO_OK && status != ISO_BAD_CONFIG)
        fuzz_right(status);
    return 0;
}
