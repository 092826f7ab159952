/* Options: what the user may choose.
 *
 * One table (options.inl) lists them all. A struct iso_options is plain data without pointers: copy
 * it by assignment, share it between threads as const, never free it. Numbers hold decimals of up
 * to nine places exactly, so that a value that is printed and read again is the same value. */
#ifndef ISOSLICE_CONFIG_H
#define ISOSLICE_CONFIG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <isoslice/fill.h>
#include <isoslice/gcode.h>
#include <isoslice/geometry.h>
#include <isoslice/lattice.h>
#include <isoslice/path.h>
#include <isoslice/status.h>

#define ISO_TEXT_SIZE 16384  /* bytes of a text option, its end included */
#define ISO_POINTS_MAX 256   /* corners of a bed */
#define ISO_NUMBERS_MAX 4096 /* numbers in a list */

/* A number in the option's unit, or in percent of what the option's help names. */
typedef struct iso_relative {
    double value;
    bool percent;
} iso_relative;

static inline double iso_relative_of(iso_relative relative, double whole) {
    return relative.percent ? relative.value / 100 * whole : relative.value;
}

typedef struct iso_place { /* mm; if not given, x = y = 0 */
    bool given;
    double x, y;
} iso_place;

typedef struct iso_points { /* mm */
    int32_t count;
    iso_vec2 point[ISO_POINTS_MAX];
} iso_points;

typedef struct iso_numbers {
    int32_t count;
    double value[ISO_NUMBERS_MAX];
} iso_numbers;

typedef enum iso_seam {
    ISO_SEAM_RANDOM,
    ISO_SEAM_NEAREST,
    ISO_SEAM_ALIGNED,
    ISO_SEAM_REAR
} iso_seam;
typedef enum iso_brim_type {
    ISO_BRIM_NONE,
    ISO_BRIM_OUTER,
    ISO_BRIM_INNER,
    ISO_BRIM_BOTH
} iso_brim_type;
typedef enum iso_draft_shield {
    ISO_SHIELD_DISABLED,
    ISO_SHIELD_LIMITED,
    ISO_SHIELD_ENABLED
} iso_draft_shield;
typedef enum iso_fuzzy_skin { ISO_FUZZY_NONE, ISO_FUZZY_EXTERNAL, ISO_FUZZY_ALL } iso_fuzzy_skin;
typedef enum iso_ironing_type {
    ISO_IRONING_TOP,
    ISO_IRONING_TOPMOST,
    ISO_IRONING_SOLID
} iso_ironing_type;
typedef enum iso_limits_usage {
    ISO_LIMITS_EMIT,
    ISO_LIMITS_ESTIMATE,
    ISO_LIMITS_IGNORE
} iso_limits_usage;
typedef enum iso_arc_fitting { ISO_ARCS_DISABLED, ISO_ARCS_EMIT_CENTER } iso_arc_fitting;
typedef enum iso_cut_keep { ISO_CUT_BOTH, ISO_CUT_UPPER, ISO_CUT_LOWER } iso_cut_keep;
typedef enum iso_mirror { ISO_MIRROR_NONE, ISO_MIRROR_X, ISO_MIRROR_Y, ISO_MIRROR_Z } iso_mirror;

typedef enum iso_check_solid { ISO_CHECK_OFF, ISO_CHECK_AUTO, ISO_CHECK_FULL } iso_check_solid;
typedef enum iso_repair { ISO_REPAIR_MEND, ISO_REPAIR_VOLUME } iso_repair;

typedef enum iso_option_kind {
    ISO_VALUE_BOOL,     /* bool */
    ISO_VALUE_INTEGER,  /* int32_t */
    ISO_VALUE_NUMBER,   /* double, in the option's unit */
    ISO_VALUE_PERCENT,  /* double: 20 is 20 % */
    ISO_VALUE_RELATIVE, /* iso_relative */
    ISO_VALUE_TEXT,     /* char [ISO_TEXT_SIZE], lines end in '\n' */
    ISO_VALUE_PLACE,    /* iso_place */
    ISO_VALUE_POINTS,   /* iso_points */
    ISO_VALUE_NUMBERS,  /* iso_numbers */
    /* words of a list, each an int32_t of the enum */
    ISO_VALUE_PATTERN,    /* iso_fill_pattern */
    ISO_VALUE_FLAVOUR,    /* iso_flavour */
    ISO_VALUE_SEAM,       /* iso_seam */
    ISO_VALUE_BRIM,       /* iso_brim_type */
    ISO_VALUE_SHIELD,     /* iso_draft_shield */
    ISO_VALUE_FUZZY,      /* iso_fuzzy_skin */
    ISO_VALUE_IRONING,    /* iso_ironing_type */
    ISO_VALUE_LIMITS,     /* iso_limits_usage */
    ISO_VALUE_LABELS,     /* iso_label_style */
    ISO_VALUE_ARCS,       /* iso_arc_fitting */
    ISO_VALUE_CUT,        /* iso_cut_keep */
    ISO_VALUE_MIRROR,     /* iso_mirror */
    ISO_VALUE_MAP,        /* iso_lattice_map */
    ISO_VALUE_CHECK,      /* iso_check_solid */
    ISO_VALUE_REPAIR,     /* iso_repair */
    ISO_VALUE_KINEMATICS, /* iso_kinematics */
    ISO_VALUE_FEED        /* iso_feed_mode */
} iso_option_kind;

static inline bool iso_option_is_word(iso_option_kind kind) {
    return kind >= ISO_VALUE_PATTERN;
}

#define ISO_FOREIGN_SIZE 65536

/* What files say for keys that are no options of ours, for the macros of G-code texts: each a key
 * and its value as the file has it, both ended by a 0, one after the other. What doesn't fit is not
 * kept. */
typedef struct iso_foreign {
    int32_t used; /* bytes */
    char text[ISO_FOREIGN_SIZE];
} iso_foreign;

typedef struct iso_options {
#define ISO_FIELD_BOOL(key) bool key;
#define ISO_FIELD_INTEGER(key) int32_t key;
#define ISO_FIELD_NUMBER(key) double key;
#define ISO_FIELD_PERCENT(key) double key;
#define ISO_FIELD_RELATIVE(key) iso_relative key;
#define ISO_FIELD_PATTERN(key) int32_t key;
#define ISO_FIELD_FLAVOUR(key) int32_t key;
#define ISO_FIELD_SEAM(key) int32_t key;
#define ISO_FIELD_BRIM(key) int32_t key;
#define ISO_FIELD_SHIELD(key) int32_t key;
#define ISO_FIELD_FUZZY(key) int32_t key;
#define ISO_FIELD_IRONING(key) int32_t key;
#define ISO_FIELD_LIMITS(key) int32_t key;
#define ISO_FIELD_LABELS(key) int32_t key;
#define ISO_FIELD_ARCS(key) int32_t key;
#define ISO_FIELD_CUT(key) int32_t key;
#define ISO_FIELD_MIRROR(key) int32_t key;
#define ISO_FIELD_MAP(key) int32_t key;
#define ISO_FIELD_CHECK(key) int32_t key;
#define ISO_FIELD_REPAIR(key) int32_t key;
#define ISO_FIELD_KINEMATICS(key) int32_t key;
#define ISO_FIELD_FEED(key) int32_t key;
#define ISO_FIELD_TEXT(key) char key[ISO_TEXT_SIZE];
#define ISO_FIELD_PLACE(key) iso_place key;
#define ISO_FIELD_POINTS(key) iso_points key;
#define ISO_FIELD_NUMBERS(key) iso_numbers key;
#define ISO_OPTION(key, kind, initial, unit, min, max, category, help) ISO_FIELD_##kind(key)
#include <isoslice/options.inl>
#undef ISO_OPTION
    iso_foreign foreign;
} iso_options;

/* A row of the table. All texts are constants. */
typedef struct iso_option_info {
    const char *key;
    iso_option_kind kind;
    const char *initial; /* the default, as a user would write it */
    const char *unit;    /* "" if it has none */
    double min, max;     /* bounds, both allowed; of no meaning for bools, words and texts */
    const char *category;
    const char *help;
} iso_option_info;

ISO_API int32_t iso_option_count(void);
ISO_API const iso_option_info *iso_option_at(int32_t option); /* 0 <= option < count */
/* The number of an option by its key ('-' counts as '_'), or -1. */
ISO_API int32_t iso_option_find(const char *key);
/* Word i of an option whose kind is a list of words; NULL behind the last one. */
ISO_API const char *iso_option_word(int32_t option, int32_t i);
/* The known key nearest to a mistyped one, or NULL if none is near. */
ISO_API const char *iso_option_suggest(const char *key);

ISO_API void iso_options_defaults(iso_options *options);

/* Set one option from text. `where` (a flag, "file:12") begins the message of a failure:
 * ISO_BAD_CONFIG for an unknown key, a value that can't be read or is out of range; the options
 * then are as before. */
ISO_API iso_status iso_options_set(iso_options *options, const char *key, const char *value,
                                   const char *where) ISO_MUST_CHECK;

/* What files had that isn't ours: keys we don't know; and what they say for a key of ours that we
 * can't follow (a word of a list that we don't have, a parent that isn't there), so that the option
 * keeps its value. Each once, comma-separated; what doesn't fit is counted alone. Zero-initialise.
 */
typedef struct iso_config_notes {
    int32_t unknown_count, unused_count;
    char unknown[16384]; /* "key, key" */
    char unused[2048];   /* "key = word, key = word" */
} iso_config_notes;

/* Read a configuration: a flat ini file of `key = value` lines; a bundle with [print:NAME],
 * [filament:NAME] and [printer:NAME] sections; or the settings at the end of a G-code file.
 *
 * Of a bundle, `path` says which sections to take, as "bundle.ini:print:0.20mm:filament:PLA"; else
 * its [presets] section does. What a section `inherits` comes before it. Later lines win. A list
 * where a number is due, one value per extruder, gives its first. Notes are added to `notes`.
 * ISO_BAD_CONFIG, naming file and line; the options then are as before. */
ISO_API iso_status iso_options_read(iso_options *options, const char *path,
                                    iso_config_notes *notes) ISO_MUST_CHECK;

/* Rules between options: the message names both. ISO_BAD_CONFIG. */
ISO_API iso_status iso_options_check(const iso_options *options) ISO_MUST_CHECK;

/* Write an option's value as text that iso_options_set reads back to the same value: at most
 * size - 1 bytes and a closing 0. Returns the whole length, as snprintf does. */
ISO_API size_t iso_options_format(char *text, size_t size, const iso_options *options,
                                  int32_t option);
ISO_API bool iso_options_is_default(const iso_options *options, int32_t option);

/* Call print(payload, key, value) for every option in the order of the table, or only for those
 * that differ from their defaults. A failure of print ends it and is returned. */
typedef iso_status iso_option_printer(void *payload, const char *key, const char *value);
ISO_API iso_status iso_options_print(const iso_options *options, iso_option_printer *print,
                                     void *payload) ISO_MUST_CHECK;
ISO_API iso_status iso_options_print_changed(const iso_options *options, iso_option_printer *print,
                                             void *payload) ISO_MUST_CHECK;

/* Copy a G-code text with its macros evaluated (docs/macros.md), as far as they need no job.
 * ISO_BAD_CONFIG says where the text is wrong, or that the result has more than size - 1 bytes. */
ISO_API iso_status iso_options_expand(char *out, size_t size, const char *text,
                                      const iso_options *options) ISO_MUST_CHECK;

/* Values that follow from several options, by PrusaSlicer's rules. Heights and widths in mm, speeds
 * in mm/s. */
ISO_API double iso_options_first_height(const iso_options *options);
/* All heights from the bed up, for iso_levels_from_heights: the last one goes on. Returns how many,
 * at most ISO_NUMBERS_MAX + 1. */
ISO_API int32_t iso_options_heights(double height[ISO_NUMBERS_MAX + 1], const iso_options *options);
ISO_API double iso_options_width(const iso_options *options, iso_role role, bool first_layer,
                                 double layer_height);
ISO_API double iso_options_speed(const iso_options *options, iso_role role, bool small_perimeter,
                                 bool first_layer);
ISO_API double iso_options_infill_overlap(const iso_options *options, bool first_layer,
                                          double layer_height);
/* Where the print's middle comes to lie: `center`, or the middle of the bed's box. */
ISO_API iso_vec2 iso_options_center(const iso_options *options);

#endif
