#include "modifier.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "planar/section.h"

/* ---- the option ---- */

static const char *const allowed[] = {
    "fill_density", "fill_angle",      "fill_pattern",    "infill_anchor", "infill_anchor_max",
    "lattice_cell", "lattice_density", "lattice_map",     "lattice_seed",  "lattice_pore",
    "lattice_file", "lattice_grid",    "lattice_material"};
#define ALLOWED                                                                                    \
    "fill_density, fill_angle, fill_pattern, infill_anchor, infill_anchor_max or lattice_..."

enum { WORD_SIZE = 256 };

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

static bool in_key(char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/* The length of "key=", or 0. */
static size_t key_length(const char *text, const char *end) {
    size_t n = 0;
    while (text + n < end && in_key(text[n]))
        n++;
    return n > 0 && text + n < end && text[n] == '=' ? n + 1 : 0;
}

/* The first key, so that there may be blanks in the name before it. */
static const char *first_key(const char *line, const char *end) {
    for (const char *c = line; c < end; c++)
        if ((c == line || is_blank(c[-1])) && key_length(c, end) > 0)
            return c;
    return end;
}

static bool is_allowed(const char *key) {
    int32_t option = iso_option_find(key);
    if (option < 0) /* setting it will say so */
        return true;
    for (size_t i = 0; i < sizeof allowed / sizeof *allowed; i++)
        if (strcmp(iso_option_at(option)->key, allowed[i]) == 0)
            return true;
    return false;
}

static iso_status set_key(iso_modifier *modifier, const char *text, const char *end) {
    char key[WORD_SIZE], value[WORD_SIZE], where[48];
    size_t length = key_length(text, end);
    snprintf(where, sizeof where, "modifiers, line %d", modifier->line);
    if (length == 0 || length > sizeof key || (size_t)(end - text) - length >= sizeof value)
        return iso_fail(ISO_BAD_CONFIG, "%s: %.*s is no key=value", where,
                        (int)(end - text < 80 ? end - text : 80), text);
    snprintf(key, sizeof key, "%.*s", (int)length - 1, text);
    snprintf(value, sizeof value, "%.*s", (int)(end - text - (int64_t)length), text + length);
    if (!is_allowed(key))
        return iso_fail(ISO_BAD_CONFIG,
                        "%s: %.60s is the same everywhere in a print; a modifier "
                        "changes " ALLOWED,
                        where, key);
    return iso_options_set(modifier->options, key, value, where);
}

static iso_status set_keys(iso_modifier *modifier, const char *text, const char *end) {
    while (text < end) {
        const char *from = text;
        while (text < end && !is_blank(*text))
            text++;
        ISO_TRY(set_key(modifier, from, text));
        while (text < end && is_blank(*text))
            text++;
    }
    if (iso_options_check(modifier->options) == ISO_OK)
        return ISO_OK;
    return iso_fail(ISO_BAD_CONFIG, "modifiers, line %d: %s", modifier->line, iso_error_message());
}

static iso_status add_modifier(iso_modifiers *modifiers, const char *text, const char *end,
                               int32_t line) {
    const char *keys = first_key(text, end), *name_end = keys;
    while (name_end > text && is_blank(name_end[-1]))
        name_end--;
    int length = (int)(name_end - text);
    if (length == 0)
        return iso_fail(ISO_BAD_CONFIG, "modifiers, line %d: give the file before its keys", line);
    if (keys == end)
        return iso_fail(ISO_BAD_CONFIG,
                        "modifiers, line %d: %.*s changes nothing; add key=value for " ALLOWED,
                        line, length < 120 ? length : 120, text);
    ISO_TRY(ISO_GROW(modifiers->modifier, modifiers->capacity, (int64_t)modifiers->count + 1));
    iso_modifier *modifier = &modifiers->modifier[modifiers->count++];
    *modifier = (iso_modifier){.line = line};
    ISO_TRY(ISO_ALLOCATE(modifier->path, (int64_t)length + 1));
    memcpy(modifier->path, text, (size_t)length);
    modifier->path[length] = 0;
    ISO_TRY(ISO_ALLOCATE(modifier->options, 1));
    *modifier->options = *modifiers->options;
    return set_keys(modifier, keys, end);
}

static iso_status refuse(const char *option, const char *why) {
    return iso_fail(ISO_BAD_CONFIG, "modifiers and %s don't go together: %s", option, why);
}

static iso_status check_others(const iso_options *options, int32_t model_count) {
    static const char *const apart = "several models have to be one object, with the modifiers";
    if (options->infill_every_layers > 1)
        return refuse("infill_every_layers", "infill is drawn layer by layer around a modifier");
    if (options->split)
        return refuse("split", apart);
    if (options->cut > 0)
        return refuse("cut", "a cut moves the halves");
    if (model_count > 1 && options->arrange)
        return refuse("arrange", apart);
    if (model_count > 1 && options->duplicate > 1)
        return refuse("duplicate", apart);
    if (model_count > 1 && options->complete_objects)
        return refuse("complete_objects", apart);
    return ISO_OK;
}

static iso_status make_shell_options(iso_modifiers *modifiers) {
    bool sparse = false;
    for (int32_t i = 0; i < modifiers->count; i++)
        sparse = sparse || settings_density(modifiers->modifier[i].options) < 100;
    if (!sparse || settings_density(modifiers->options) < 100)
        return ISO_OK;
    ISO_TRY(ISO_ALLOCATE(modifiers->shelled, 1));
    *modifiers->shelled = *modifiers->options;
    modifiers->shelled->fill_density = 99;
    modifiers->shelled->fill_pattern = ISO_PATTERN_RECTILINEAR;
    return ISO_OK;
}

iso_status modifiers_parse(iso_modifiers *modifiers, const iso_options *options,
                           int32_t model_count) {
    int32_t line = 1;
    modifiers->options = options;
    for (const char *text = options->modifiers; *text; line++) {
        const char *end = text + strcspn(text, ";\n"), *last = end;
        while (text < last && is_blank(*text))
            text++;
        while (last > text && is_blank(last[-1]))
            last--;
        if (text < last)
            ISO_TRY(add_modifier(modifiers, text, last, line));
        text = end + (*end != 0);
    }
    if (modifiers->count == 0)
        return ISO_OK;
    ISO_TRY(check_others(options, model_count));
    return make_shell_options(modifiers);
}

void modifiers_free(iso_modifiers *modifiers) {
    for (int32_t i = 0; i < modifiers->count; i++) {
        iso_modifier *modifier = &modifiers->modifier[i];
        iso_release(modifier->path);
        iso_release(modifier->options);
        iso_mesh_free(&modifier->mesh);
        iso_slices_free(&modifier->slices);
    }
    iso_release(modifiers->modifier);
    iso_release(modifiers->shelled);
    *modifiers = (iso_modifiers){0};
}

const iso_options *modifiers_shell_options(const iso_modifiers *modifiers) {
    return modifiers->shelled ? modifiers->shelled : modifiers->options;
}

/* ---- files ---- */

iso_status modifiers_load(iso_mesh *mesh, const iso_modifiers *modifiers, iso_report *report) {
    for (int32_t i = 0; i < modifiers->count; i++) {
        ISO_TRY(iso_mesh_read(&mesh[i], modifiers->modifier[i].path));
        ISO_TRY(iso_report_warn_mended(report, modifiers->modifier[i].path, &mesh[i].defects));
    }
    return ISO_OK;
}

iso_status modifiers_slice(iso_modifiers *modifiers, const iso_levels *levels,
                           const iso_curved *curved) {
    modifiers->levels = levels;
    for (int32_t i = 0; i < modifiers->count; i++) {
        iso_modifier *modifier = &modifiers->modifier[i];
        if (curved_is_flat(curved))
            ISO_TRY(iso_slice_planar(&modifier->slices, &modifier->mesh, levels));
        else
            ISO_TRY(curved_slice(&modifier->slices, curved, &modifier->mesh, levels));
        iso_mesh_free(&modifier->mesh);
    }
    return ISO_OK;
}

/* ---- layers ---- */

const iso_options *modifiers_options(const iso_modifiers *modifiers, int32_t k) {
    return k < modifiers->count ? modifiers->modifier[k].options : modifiers->options;
}

static bool is_full(const iso_modifiers *modifiers, int32_t k) {
    return settings_density(modifiers_options(modifiers, k)) >= 100;
}

static iso_status prepare(iso_modified *out, const iso_modifiers *modifiers) {
    if (out->count == modifiers->count)
        return ISO_OK;
    modified_free(out);
    ISO_TRY(ISO_ALLOCATE(out->piece, modifiers->count));
    memset(out->piece, 0, (size_t)modifiers->count * sizeof *out->piece);
    ISO_TRY(ISO_ALLOCATE(out->used, modifiers->count));
    memset(out->used, 0, (size_t)modifiers->count * sizeof *out->used);
    out->count = modifiers->count;
    return ISO_OK;
}

void modified_free(iso_modified *modified) {
    for (int32_t i = 0; i < modified->count; i++)
        iso_region_free(&modified->piece[i]);
    iso_release(modified->piece);
    iso_release(modified->used);
    iso_region_free(&modified->raw);
    iso_region_free(&modified->section);
    iso_region_free(&modified->edge);
    iso_region_free(&modified->spare[0]);
    iso_region_free(&modified->spare[1]);
    *modified = (iso_modified){0};
}

/* a kind b, b grown by so much. */
static iso_status combine(iso_region *to, iso_boolean_kind kind, const iso_region *a,
                          iso_modified *m, int32_t grown, iso_planar_scratch *scratch) {
    iso_offset_options offset = iso_offset_defaults(grown);
    const iso_region *b = &m->section;
    if (grown != 0) {
        ISO_TRY(iso_offset(&m->edge, b, &offset, scratch));
        b = &m->edge;
    }
    return iso_boolean(to, kind, a, b, scratch);
}

static iso_status take_piece(iso_modified *out, const iso_modifiers *modifiers, int32_t k,
                             int32_t index, int32_t overlap, iso_planar_scratch *scratch) {
    iso_region *left = out->rest == &out->spare[0] ? &out->spare[1] : &out->spare[0];
    iso_region_clear(&out->piece[k]);
    iso_region_clear(&out->raw);
    ISO_TRY(section_add(&out->raw, &modifiers->modifier[k].slices, index));
    if (out->rest->count == 0 || out->raw.count == 0)
        return ISO_OK;
    ISO_TRY(iso_region_clean(&out->section, &out->raw, ISO_FILL_POSITIVE, scratch));
    ISO_TRY(combine(&out->piece[k], ISO_INTERSECTION, out->rest, out,
                    is_full(modifiers, k) ? 0 : -overlap, scratch));
    ISO_TRY(combine(left, ISO_DIFFERENCE, out->rest, out,
                    is_full(modifiers, modifiers->count) ? 0 : overlap, scratch));
    out->rest = left;
    out->used[k] = out->used[k] || out->piece[k].count > 0;
    return ISO_OK;
}

iso_status modifiers_split(iso_modified *out, const iso_modifiers *modifiers,
                           const iso_region *sparse, int32_t index, int32_t overlap,
                           iso_planar_scratch *scratch) {
    ISO_TRY(prepare(out, modifiers));
    out->rest = sparse;
    for (int32_t k = modifiers->count; k-- > 0;)
        ISO_TRY(take_piece(out, modifiers, k, index, overlap, scratch));
    return ISO_OK;
}

bool modifiers_fill(iso_fill_options *fill, const iso_modifiers *modifiers, int32_t k,
                    int32_t index) {
    iso_layer_settings settings = {0};
    settings_of_layer(&settings, modifiers_options(modifiers, k), index,
                      modifiers->levels->height[index]);
    *fill = settings.sparse;
    fill->z = iso_units(modifiers->levels->cut[index]);
    return settings.has_sparse;
}

iso_status modifiers_open(const iso_region **open, iso_modified *out,
                          const iso_modifiers *modifiers, const iso_region *sparse, int32_t index,
                          iso_planar_scratch *scratch) {
    bool full = false;
    for (int32_t k = 0; k <= modifiers->count; k++)
        full = full || is_full(modifiers, k);
    *open = sparse;
    if (!full)
        return ISO_OK;
    ISO_TRY(modifiers_split(out, modifiers, sparse, index, 0, scratch));
    iso_region_clear(&out->raw);
    for (int32_t k = 0; k <= modifiers->count; k++) {
        const iso_region *piece = modified_piece(out, k);
        for (int32_t c = 0; c < piece->count && !is_full(modifiers, k); c++)
            ISO_TRY(iso_region_add(&out->raw, piece->point + piece->first[c],
                                   piece->first[c + 1] - piece->first[c]));
    }
    *open = &out->section;
    return iso_region_clean(&out->section, &out->raw, ISO_FILL_POSITIVE, scratch);
}
