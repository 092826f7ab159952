/* PrusaSlicer's macro language, as it stands in the G-code texts of options: [key], {expression},
 * {if ...}{endif}. docs/macros.md has all of it.
 *
 * A text is read and evaluated in one pass. What its conditions leave out is checked for its form,
 * not evaluated. Nesting, lengths and scratch are bounded, so any text ends, and soon. */
#ifndef ISO_MACRO_MACRO_H
#define ISO_MACRO_MACRO_H

#include <isoslice/config.h>

/* What a job knows of itself before its first line is written. Lengths in mm, places on the bed. */
typedef struct iso_macro_job {
    const char *input_filename; /* the first model's, with or without folders; NULL: none */
    int64_t timestamp;          /* seconds since 1970, UTC */
    int32_t object_count, instance_count, layer_count;
    iso_vec2 print_min, print_max; /* of the first layer, with its skirt */
    int32_t hull_count;            /* its convex hull; 0: the box */
    const iso_vec2 *hull;
} iso_macro_job;

/* A number known where the text stands: layer_num, layer_z, max_layer_z ... */
typedef struct iso_macro_number {
    const char *key;
    double value;
    bool whole;
} iso_macro_number;

/* Variables that outlive their text: {global x = 1}. Zero-initialise. Not shared by threads. */
typedef struct iso_macro_globals {
    struct iso_macro_variable *variable;
    int32_t count;
    int64_t capacity;
} iso_macro_globals;

void iso_macro_globals_free(iso_macro_globals *globals);

/* What names stand for: first variables, then `number`, the job, the options, the keys of files
 * that are no options (options->foreign), and PrusaSlicer's defaults. */
typedef struct iso_macro_scope {
    const iso_options *options;
    const iso_macro_job *job; /* NULL: unknown, and so are its values */
    const iso_macro_number *number;
    int32_t number_count;
    iso_macro_globals *globals; /* NULL: globals end with the text as locals do */
} iso_macro_scope;

/* Write `text` with its macros replaced: at most size - 1 bytes and a closing 0. `name` is what
 * messages call the text, as "start_gcode". ISO_BAD_CONFIG, naming text, line, column and what was
 * expected. Globals keep what was assigned before a failure. */
iso_status iso_macro_expand(char *out, size_t size, const char *text, const char *name,
                            const iso_macro_scope *scope) ISO_MUST_CHECK;

/* Check the form alone, in all branches. */
iso_status iso_macro_check(const char *text, const char *name) ISO_MUST_CHECK;

/* Does a file give the option of that key as a list of texts, "a";"b", one per extruder? */
bool iso_macro_is_text_list(const char *key);

#endif
