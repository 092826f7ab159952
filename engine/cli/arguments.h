/* The command line, read into one struct. */
#ifndef ISO_CLI_ARGUMENTS_H
#define ISO_CLI_ARGUMENTS_H

#include <stdbool.h>
#include <stdint.h>

#include <isoslice/channel.h>
#include <isoslice/config.h>
#include <isoslice/status.h>

typedef enum iso_verb {
    ISO_VERB_SLICE,
    ISO_VERB_CONTOURS,
    ISO_VERB_INFO,
    ISO_VERB_PREVIEW,
    ISO_VERB_LATTICE,
    ISO_VERB_CHANNELS,
    ISO_VERB_COUNT
} iso_verb;

const char *iso_verb_name(iso_verb verb);
/* Are the options of a print flags of it? */
bool iso_verb_has_options(iso_verb verb);

typedef struct iso_flag_info {
    const char *name; /* '_' stands for '-' */
    char letter;
    const char *argument; /* "" if it takes none */
    unsigned verbs;       /* bit 1 << iso_verb */
    const char *help;
} iso_flag_info;

int iso_flag_count(void);
const iso_flag_info *iso_flag_at(int flag);

typedef enum iso_page {
    ISO_PAGE_NONE,
    ISO_PAGE_HELP,
    ISO_PAGE_VERSION,
    ISO_PAGE_OPTIONS,
    ISO_PAGE_OPTIONS_MARKDOWN,
    ISO_PAGE_MAN
} iso_page;

enum { ISO_LAYERS_MAX = 256 };

typedef struct iso_arguments {
    iso_verb verb;
    bool verb_given, view_given;
    iso_page page; /* to be printed instead of working */
    bool strict, quiet, progress, timestamp, travels, json;
    int32_t threads, columns;
    double voxel;                /* mm; 0: automatic */
    double view[2];              /* degrees: azimuth and elevation of the eye */
    const char *output, *report; /* NULL if not given; borrowed from argv, as the files are */
    const char *const *file;
    int32_t file_count, config_count;
    int32_t layer[ISO_LAYERS_MAX], layer_count;
    iso_channel_options channels; /* but for the section */
    const char *section;          /* NULL if not given */
    int32_t sides;                /* of the section */
    const char *write;            /* NULL if not given */
    iso_options options;
    iso_config_notes notes;
} iso_arguments;

/* Reorders argv. ISO_USAGE or a failure of reading options. */
iso_status iso_arguments_read(iso_arguments *arguments, int argc, char **argv) ISO_MUST_CHECK;

#endif
