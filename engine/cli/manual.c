/* What the program prints about itself: help, lists of options, the manual page. */
#include <isoslice/version.h>

#include <stdio.h>
#include <string.h>

#include "config/value.h"
#include "verbs.h"

#define RANGE_SIZE 1024 /* of the longest list of words with room for more */

static const char *const verb_usage[] = {
    "isoslice [slice] [options] part.stl [more.stl...] [-o part.gcode]",
    "isoslice contours [options] part.stl [more.stl...] [-o part.mlk|part.json|part.svg]",
    "isoslice info [--json] part.stl [more.stl...]",
    "isoslice preview part.gcode [-o part.svg]",
    "isoslice lattice [options] part.stl -o lattice.stl|lattice.vdb|lattice.gcode",
    "isoslice channels [flags] part.stl -o channels.stl|mould.stl|channels.mlk|channels.svg",
};

static const char *const verb_help[] = {
    "Slice models into G-code, all of them for one bed.",
    "Cut models into the contours of their layers: as a link file, as JSON or as a picture.",
    "Say how many triangles a model has, how large it is, and what is wrong with it.",
    "Draw layers of a G-code file as a picture.",
    "Make a model porous: as a mesh, as a volume (OpenVDB) or as G-code, with a report of its pores.",
    "Lead cooling channels around a part: as bodies, a mould that has them, a link or a picture.",
};

/* Exit codes and what they mean. */
static const struct {
    int code;
    const char *meaning;
} exit_codes[] = {
    {ISO_OK, "Done."},
    {ISO_USAGE, "A command line that makes no sense."},
    {ISO_UNREADABLE, "A file that can't be read or is no model."},
    {ISO_UNSLICEABLE, "A model that can't be sliced truthfully."},
    {ISO_OUTSIDE, "A model outside the printer's volume, or no room for it on the bed."},
    {ISO_BAD_CONFIG, "An option out of its range, a configuration that can't be read."},
    {ISO_NOT_WRITTEN, "Output that could not be written."},
    {ISO_NOT_VERIFIED, "A result that failed its own check."},
    {ISO_NO_MEMORY, "Not enough memory."},
    {ISO_BUG, "A defect of isoslice."},
};

enum { EXIT_CODE_COUNT = sizeof exit_codes / sizeof *exit_codes };

/* "--layer-height" */
static const char *flag_name(char text[64], const char *key) {
    snprintf(text, 64, "--%s", key);
    for (char *c = text; *c; c++)
        *c = *c == '_' ? '-' : *c;
    return text;
}

/* Print words, broken before `width` columns, the lines behind the first indented. */
static void print_wrapped(const char *text, int indent, int width) {
    int column = indent;
    while (*text) {
        int length = (int)strcspn(text, " ");
        if (column > indent && column + 1 + length > width) {
            printf("\n%*s", indent, "");
            column = indent;
        } else if (column > indent) {
            putchar(' ');
            column++;
        }
        printf("%.*s", length, text);
        column += length;
        text += length;
        text += strspn(text, " ");
    }
    putchar('\n');
}

/* ---- help ---- */

static void print_flags(iso_verb verb) {
    for (int i = 0; i < iso_flag_count(); i++) {
        const iso_flag_info *flag = iso_flag_at(i);
        char name[64], text[96], letter[8] = "    ";
        if (!(flag->verbs & 1u << verb))
            continue;
        if (flag->letter)
            snprintf(letter, sizeof letter, "-%c, ", flag->letter);
        snprintf(text, sizeof text, "%s%s %s", letter, flag_name(name, flag->name), flag->argument);
        printf("  %-22s ", text);
        print_wrapped(flag->help, 25, 100);
    }
}

static void print_help(const iso_arguments *arguments) {
    bool all = !arguments->verb_given;
    printf("usage: %s\n", verb_usage[arguments->verb]);
    for (int v = 1; v < ISO_VERB_COUNT && all; v++)
        printf("       %s\n", verb_usage[v]);
    printf("\n%s%s\n\n", verb_help[arguments->verb], all ? " Each verb has its own --help." : "");
    print_flags(arguments->verb);
    if (iso_verb_has_options(arguments->verb))
        printf(
            "\nEvery option of a print is a flag too, as --layer-height 0.2; those that are 0 or 1 are\n"
            "switches, as --ironing and --no-cooling. --list-options has them all. They have\n"
            "PrusaSlicer's names and meaning.\n");
}

/* ---- options ---- */

/* "0.01 to 5", "rectilinear, grid" or "" */
static void format_range(char *text, size_t size, int32_t option) {
    const iso_option_info *info = iso_option_at(option);
    char low[32], high[32];
    size_t length = 0;
    text[0] = 0;
    for (int32_t i = 0; iso_option_word(option, i) && length < size; i++)
        length += (size_t)snprintf(text + length, size - length, "%s%s", i > 0 ? ", " : "",
                                   iso_option_word(option, i));
    if (length > 0 || info->kind == ISO_VALUE_TEXT)
        return;
    iso_number_write(low, info->min);
    iso_number_write(high, info->max);
    snprintf(text, size, info->kind == ISO_VALUE_BOOL ? "%s or %s" : "%s to %s", low, high);
}

static const char *unit_of(char text[32], const iso_option_info *info) {
    bool share = info->kind == ISO_VALUE_RELATIVE;
    snprintf(text, 32, "%s%s%s", info->unit, share && *info->unit ? " " : "", share ? "or %" : "");
    return text;
}

static void list_options(void) {
    const char *category = "";
    printf("%-34s  %-24s  %-9s  %-18s  %s\n", "key", "default", "unit", "range", "meaning");
    for (int32_t i = 0; i < iso_option_count(); i++) {
        const iso_option_info *info = iso_option_at(i);
        char range[RANGE_SIZE], unit[32], initial[32];
        if (strcmp(category, info->category) != 0)
            printf("\n%s\n", info->category);
        category = info->category;
        format_range(range, sizeof range, i);
        snprintf(initial, sizeof initial, strlen(info->initial) > 24 ? "%.21s..." : "%s",
                 info->initial);
        printf("%-34s  %-24s  %-9s  %-18s  %s\n", info->key, initial, unit_of(unit, info), range,
               info->help);
    }
}

static void list_options_markdown(void) {
    const char *category = "";
    printf("# Options\n\n"
           "Every option is a key of configuration files (`layer_height = 0.2`) and a flag\n"
           "(`--layer-height 0.2`). Those that are 0 or 1 are switches: `--ironing` is\n"
           "`ironing = 1`, `--no-ironing` is `ironing = 0`. Where a unit is given as \"or %%\",\n"
           "`50%%` is a share of what the meaning names. Names, units and meaning are\n"
           "PrusaSlicer's wherever it has the key. This page is printed by\n"
           "`isoslice --list-options=markdown`.\n");
    for (int32_t i = 0; i < iso_option_count(); i++) {
        const iso_option_info *info = iso_option_at(i);
        char range[RANGE_SIZE], unit[32];
        if (strcmp(category, info->category) != 0)
            printf("\n## %s\n\n| key | default | unit | range | meaning |\n|---|---|---|---|---|\n",
                   info->category);
        category = info->category;
        format_range(range, sizeof range, i);
        bool has_text = info->kind == ISO_VALUE_TEXT;
        printf("| `%s` | %s%s%s | %s | %s | %s |\n", info->key,
               *info->initial && !has_text ? "`" : "",
               *info->initial && has_text ? "below" : info->initial,
               *info->initial && !has_text ? "`" : "", unit_of(unit, info), range, info->help);
    }
    for (int32_t i = 0; i < iso_option_count(); i++) {
        static iso_value initial;
        const iso_option_info *info = iso_option_at(i);
        if (info->kind == ISO_VALUE_TEXT && *info->initial &&
            !iso_value_parse(&initial, info, info->initial))
            printf("\n`%s`:\n\n```\n%s\n```\n", info->key, initial.text);
    }
}

/* ---- the manual page ---- */

/* roff: a backslash is its escape, a dot or quote at a line's start a request, '-' a hyphen. */
static void print_roff(const char *text) {
    if (*text == '.' || *text == '\'')
        printf("\\&");
    for (; *text; text++) {
        if (*text == '\\')
            printf("\\e");
        else if (*text == '-')
            printf("\\-");
        else
            putchar(*text);
    }
    putchar('\n');
}

static void man_flags(void) {
    printf(".SH FLAGS\n");
    for (int i = 0; i < iso_flag_count(); i++) {
        const iso_flag_info *flag = iso_flag_at(i);
        char name[64], text[96], letter[8] = "";
        if (flag->letter)
            snprintf(letter, sizeof letter, "-%c, ", flag->letter);
        snprintf(text, sizeof text, "%s%s%s%s", letter, flag_name(name, flag->name),
                 *flag->argument ? " " : "", flag->argument);
        printf(".TP\n");
        print_roff(text);
        print_roff(flag->help);
    }
}

/* "--layer-height", of a switch "--ironing, --no-ironing" */
static const char *flags_of(char text[160], const iso_option_info *info) {
    char name[64];
    flag_name(name, info->key);
    snprintf(text, 160, info->kind == ISO_VALUE_BOOL ? "%s, --no-%s" : "%s", name, name + 2);
    return text;
}

static void man_options(void) {
    const char *category = "";
    printf(".SH OPTIONS OF A PRINT\n");
    print_roff(
        "Each is a flag (--layer-height 0.2), a key of configuration files (layer_height = "
        "0.2) and of -s (-s layer_height=0.2). Those that are 0 or 1 are switches: --ironing "
        "is ironing = 1, --no-ironing is ironing = 0.");
    for (int32_t i = 0; i < iso_option_count(); i++) {
        const iso_option_info *info = iso_option_at(i);
        char range[RANGE_SIZE], unit[32], flags[160];
        if (strcmp(category, info->category) != 0)
            printf(".SS %s\n", info->category);
        category = info->category;
        format_range(range, sizeof range, i);
        printf(".TP\n");
        print_roff(flags_of(flags, info));
        print_roff(info->help);
        char text[RANGE_SIZE + 256];
        snprintf(text, sizeof text, *info->initial ? "(%s%s%s; default %s)" : "(%s%s%s)", range,
                 *info->unit ? " " : "", unit_of(unit, info), info->initial);
        if (info->kind != ISO_VALUE_TEXT) {
            print_roff(text);
        } else if (*info->initial) {
            print_roff("Default:");
            print_roff(info->initial);
        }
    }
}

static void print_man(void) {
    printf(".TH ISOSLICE 1 \"\" \"isoslice %s\" \"User Commands\"\n", ISO_VERSION);
    printf(".SH NAME\nisoslice \\- slice models for 3D printers\n.SH SYNOPSIS\n.nf\n");
    for (int v = 0; v < ISO_VERB_COUNT; v++)
        print_roff(verb_usage[v]);
    printf(".fi\n.SH DESCRIPTION\n");
    for (int v = 0; v < ISO_VERB_COUNT; v++) {
        printf(".TP\n.B %s\n", iso_verb_name(v));
        print_roff(verb_help[v]);
    }
    printf(".PP\n");
    print_roff("isoslice works without any configuration. Settings come from files (-c), then from "
               "-s, then from flags; the later wins. A result appears whole or not at all, and the "
               "same input gives the same bytes.");
    man_flags();
    man_options();
    printf(".SH EXIT STATUS\n");
    for (int i = 0; i < EXIT_CODE_COUNT; i++) {
        printf(".TP\n%d\n", exit_codes[i].code);
        print_roff(exit_codes[i].meaning);
    }
    printf(".SH ENVIRONMENT\n.TP\nSOURCE_DATE_EPOCH\n");
    print_roff("Seconds since 1970 for the date in the G-code. Without it the date is a constant "
               "one, so that output stays the same; --timestamp writes the real one.");
    printf(".SH EXAMPLES\n.nf\n");
    print_roff("isoslice part.stl");
    print_roff("isoslice -c printer.ini --layer-height 0.2 part.stl -o part.gcode");
    print_roff("isoslice --arrange --duplicate 3 part.stl lid.stl");
    print_roff("isoslice preview part.gcode --layers 1,20,-1 -o part.svg");
    print_roff("isoslice channels part.stl --pitch 20 --depth 10 --section round:8 -o mould.stl");
    print_roff("isoslice lattice part.stl --lattice-cell 4 --fill-density 30% -o lattice.stl");
    printf(".fi\n");
}

iso_status iso_page_print(const iso_arguments *arguments) {
    switch (arguments->page) {
    case ISO_PAGE_HELP:
        print_help(arguments);
        break;
    case ISO_PAGE_VERSION:
        printf("isoslice %s\n", ISO_VERSION);
        break;
    case ISO_PAGE_OPTIONS:
        list_options();
        break;
    case ISO_PAGE_OPTIONS_MARKDOWN:
        list_options_markdown();
        break;
    case ISO_PAGE_MAN:
        print_man();
        break;
    case ISO_PAGE_NONE:
        break;
    }
    return ISO_OK;
}
