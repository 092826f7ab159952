/* Small prints for the tests of the writer: layers of paths in, the text read back. */
#ifndef TESTS_GCODE_SMALL_H
#define TESTS_GCODE_SMALL_H

#include "gcode/writer.h"

#include <stdlib.h>
#include <unistd.h>

#include "base/memory.h"
#include "check.h"
#include "reader.h"

/* Plain options: no start or end, no cooling, no progress. */
static inline iso_gcode_options plain(void) {
    iso_gcode_options o = iso_gcode_defaults();
    o.start_gcode = o.end_gcode = NULL;
    o.cooling = o.remaining_times = 0;
    memcpy(o.first_layer_speed, o.speed, sizeof o.speed);
    o.first_layer_small_perimeter_speed = o.small_perimeter_speed;
    return o;
}

static inline iso_status config_lines(iso_output *output, void *payload) {
    return iso_output_print(output, "; layer_height = %s\n", (const char *)payload);
}

static inline iso_status write_file(iso_gcode_totals *totals, const iso_gcode_options *options,
                                    const iso_paths *layer, int layers) {
    iso_output *output;
    iso_gcode_writer *writer = NULL;
    ISO_TRY(iso_output_open(&output, SMALL_FILE));
    iso_status status = iso_gcode_writer_new(&writer, output, options);
    if (status == ISO_OK)
        status = iso_gcode_begin(writer);
    for (int i = 0; i < layers && status == ISO_OK; i++)
        status = iso_gcode_layer(
            writer, &(iso_gcode_layer_info){
                        .index = i, .z = 2000 * (i + 1), .height = 2000, .paths = &layer[i]});
    if (status == ISO_OK)
        status = iso_gcode_finish(totals, writer, config_lines, "0.2");
    iso_gcode_writer_free(writer);
    if (status != ISO_OK) {
        iso_output_abandon(output);
        return status;
    }
    return iso_output_commit(output);
}

static inline reading print(iso_gcode_totals *totals, const iso_gcode_options *options,
                            const iso_paths *layer, int layers) {
    CHECK_OK(write_file(totals, options, layer, layers));
    reading r = reading_of(SMALL_FILE);
    CHECK_EQUAL(r.size, totals->bytes);
    unlink(SMALL_FILE);
    return r;
}

static inline void add_square(iso_paths *paths, int32_t x, int32_t y, int32_t side, iso_role role,
                              int32_t width) {
    iso_point p[4] = {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
    iso_bead bead = iso_bead_of(width, 2000);
    CHECK_OK(iso_paths_add(paths, &(iso_path){.role = (uint8_t)role, .closed = 1}, p, 4, width,
                           bead.area));
}

#endif
