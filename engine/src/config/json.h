/* Writing JSON: names and values one after the other, commas and line ends as they fall due. */
#ifndef ISO_CONFIG_JSON_H
#define ISO_CONFIG_JSON_H

#include <stdbool.h>

#include <isoslice/mesh.h>

#include "base/output.h"

typedef struct iso_json {
    iso_output *output; /* keeps its own failure, so the calls below return nothing */
    int depth;
    bool begun; /* something stands before on this level: a comma is due */
} iso_json;

/* `name` is NULL within lists and at the top. bracket is '{' or '['; end takes '}' or ']'. */
void iso_json_begin(iso_json *json, const char *name, char bracket);
void iso_json_end(iso_json *json, char bracket);
void iso_json_text(iso_json *json, const char *name, const char *text);
void iso_json_integer(iso_json *json, const char *name, int64_t integer);
void iso_json_number(iso_json *json, const char *name, double number);

/* An object called "defects". */
void iso_json_defects(iso_json *json, const iso_mesh_defects *defects);

#endif
