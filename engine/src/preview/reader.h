/* G-code as a run of moves, each with its layer, role and width. */
#ifndef ISO_PREVIEW_READER_H
#define ISO_PREVIEW_READER_H

#include <stddef.h>
#include <stdint.h>

#include <isoslice/geometry.h>
#include <isoslice/path.h>
#include <isoslice/status.h>

typedef struct iso_preview_text {
    char *bytes; /* NUL behind the last one */
    size_t size;
    const char *path; /* borrowed, for messages */
} iso_preview_text;

/* The whole file, or standard input for "-". */
iso_status iso_preview_text_read(iso_preview_text *text, const char *path) ISO_MUST_CHECK;
void iso_preview_text_free(iso_preview_text *text);

typedef struct iso_preview_move {
    iso_vec2 from, to; /* mm */
    iso_vec2 centre;   /* of an arc */
    double from_z, z;
    double width;  /* mm; 0 for a travel */
    double height; /* mm, of a bead; 0 if nothing says it */
    int8_t turn;   /* 0 straight, 1 counter-clockwise, -1 clockwise */
    uint8_t role;  /* iso_role */
    int32_t layer; /* from 0; -1 before the first */
} iso_preview_move;

typedef iso_status iso_preview_visit(void *payload, const iso_preview_move *move);

/* Visit every move that goes somewhere in x and y. `layers` gets the number of layers. */
iso_status iso_preview_read(int32_t *layers, const iso_preview_text *text, double filament_diameter,
                            iso_preview_visit *visit, void *payload) ISO_MUST_CHECK;

#endif
