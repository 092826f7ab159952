#include "arguments.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "nearest.h"

typedef enum flag_number {
#define FIO_FLAG(name, letter, argument, range, help) FLAG_##name,
#define FIO_FLAG_GROUP(title)
#include "flags.inl"
#undef FIO_FLAG
#undef FIO_FLAG_GROUP
    FLAG_NUMBERS
} flag_number;

static const fio_flag_info flag_table[] = {
#define FIO_FLAG(name, letter, argument, range, help) {#name, letter, argument, range, help},
#define FIO_FLAG_GROUP(title) {NULL, 0, "", "", title},
#include "flags.inl"
#undef FIO_FLAG
#undef FIO_FLAG_GROUP
};

enum { FLAG_ROWS = sizeof flag_table / sizeof *flag_table };

int fio_flag_count(void) {
    return FLAG_ROWS;
}

const fio_flag_info *fio_flag_at(int flag) {
    return &flag_table[flag];
}

/* ---- walking along argv ---- */

typedef struct walk {
    char **argv;
    int argc, at;
    bool files_only; /* "--" went by */
} walk;

/* One flag with its value. */
typedef struct given_flag {
    flag_number flag;
    char written[48]; /* for messages: "--resume-from" */
    const char *value;
} given_flag;

static bool same_name(const char *known, const char *given, size_t length) {
    for (size_t i = 0; i < length; i++)
        if (!known[i] || known[i] != (given[i] == '-' ? '_' : given[i]))
            return false;
    return known[length] == 0;
}

static fio_status fail_unknown(const char *written) {
    const char *name = written + strspn(written, "-"), *near = NULL;
    int best = fio_nearest_tolerance(name) + 1;
    for (int i = 0; i < FLAG_ROWS; i++) {
        int distance = flag_table[i].name ? fio_nearest_distance(flag_table[i].name, name) : best;
        if (distance < best) {
            best = distance;
            near = flag_table[i].name;
        }
    }
    char suggestion[32];
    snprintf(suggestion, sizeof suggestion, "%s", near ? near : "help");
    for (char *c = suggestion; *c; c++)
        *c = *c == '_' ? '-' : *c;
    return fio_fail(FIO_USAGE,
                    near ? "there is no flag %s; is it --%s?" : "there is no flag %s; see --%s",
                    written, suggestion);
}

/* The row of a long name or, if `length` is 0, of a letter; the number counts flags alone. */
static const fio_flag_info *find(flag_number *flag, const char *name, size_t length) {
    int number = 0;
    for (int i = 0; i < FLAG_ROWS; i++) {
        if (!flag_table[i].name)
            continue;
        *flag = (flag_number)number++;
        if (length > 0 ? same_name(flag_table[i].name, name, length)
                       : flag_table[i].letter && flag_table[i].letter == *name)
            return &flag_table[i];
    }
    return NULL;
}

static fio_status take_value(walk *along, given_flag *given, const fio_flag_info *info,
                             const char *joined) {
    given->value = joined;
    if (!*info->argument)
        return joined ? fio_fail(FIO_USAGE, "%s: takes no value", given->written) : FIO_OK;
    if (!joined && along->at < along->argc)
        given->value = along->argv[along->at++];
    bool flag_instead = !joined && given->value && !strncmp(given->value, "--", 2);
    return given->value && *given->value && !flag_instead
               ? FIO_OK
               : fio_fail(FIO_USAGE, "%s: %s is due behind it", given->written, info->argument);
}

static fio_status next_flag(walk *along, given_flag *given, const char *text) {
    bool is_long = text[1] == '-';
    const char *name = text + 1 + is_long;
    size_t length = is_long ? strcspn(name, "=") : 0;
    snprintf(given->written, sizeof given->written, "%.*s", is_long ? (int)length + 2 : 2, text);
    const fio_flag_info *info = is_long && length == 0 ? NULL : find(&given->flag, name, length);
    if (!info)
        return fail_unknown(given->written);
    const char *joined = name + (is_long ? length : 1);
    if (!is_long && *joined && !*info->argument)
        return fio_fail(FIO_USAGE, "%s: write the letters apart", text);
    joined += is_long && *joined == '=';
    bool has_value = is_long ? name[length] == '=' : *joined != 0;
    return take_value(along, given, info, has_value ? joined : NULL);
}

/* ---- values ---- */

/* A number from `least` to `most`; *end is what follows it. */
static bool read_number(double *value, const char *text, double least, double most,
                        const char **end) {
    *end = fio_number_read(value, text, text + strlen(text));
    return *end != text && *value >= least && *value <= most;
}

static bool read_whole(int64_t *value, const char *text, int64_t least, int64_t most,
                       const char **end) {
    double number;
    if (!read_number(&number, text, (double)least, (double)most, end) ||
        number != (double)(int64_t)number)
        return false;
    *value = (int64_t)number;
    return true;
}

static fio_status fail_value(const given_flag *given, const char *due) {
    return fio_fail(FIO_USAGE, "%s %.60s: %s is due", given->written, given->value, due);
}

static fio_status read_baud(fio_arguments *arguments, const given_flag *given) {
    const char *end;
    arguments->baud_given = true;
    if (!strcmp(given->value, "auto")) {
        arguments->baud = 0;
        return FIO_OK;
    }
    if (!read_whole(&arguments->baud, given->value, 1200, 4000000, &end) || *end)
        return fail_value(given, "auto or a whole number of bits/s from 1200 to 4000000");
    return FIO_OK;
}

static fio_status read_wait(fio_arguments *arguments, const given_flag *given) {
    const char *end;
    if (!read_number(&arguments->wait, given->value, 0, 86400, &end) || *end)
        return fail_value(given, "a number of seconds from 0 to 86400");
    return FIO_OK;
}

static fio_status read_window(fio_arguments *arguments, const given_flag *given) {
    static const char due[] = "LINES or LINES:BYTES, 1 to 64 lines and 16 to 65536 bytes,";
    const char *end;
    int64_t lines, bytes = 0;
    if (!read_whole(&lines, given->value, 1, 64, &end) || (*end && *end != ':'))
        return fail_value(given, due);
    if (*end && (!read_whole(&bytes, end + 1, 16, 65536, &end) || *end))
        return fail_value(given, due);
    arguments->window_lines = (int)lines;
    arguments->window_bytes = (int)bytes;
    return FIO_OK;
}

static fio_status read_bed(fio_arguments *arguments, const given_flag *given) {
    const char *at = given->value;
    for (int i = 0; i < 3; i++) {
        const char *end;
        if (!read_number(&arguments->bed[i], at, 1, 10000, &end) || *end != (i < 2 ? 'x' : 0))
            return fail_value(given, "XxYxZ in mm, as 250x210x210, 1 to 10000 each,");
        at = end + 1;
    }
    return FIO_OK;
}

/* The card's names go into a command: nothing that would end or change it. */
static fio_status read_upload(fio_arguments *arguments, const given_flag *given) {
    size_t length = strlen(given->value);
    for (size_t i = 0; i < length; i++)
        if (given->value[i] <= ' ' || given->value[i] > '~' || strchr(";*\"\\()", given->value[i]))
            return fail_value(given, "a name without blanks, quotes, ; * \\ ( and )");
    if (length > 64)
        return fail_value(given, "a name of at most 64 characters");
    arguments->upload = given->value;
    return FIO_OK;
}

static fio_status read_send(fio_arguments *arguments, const given_flag *given) {
    if (arguments->send_count == FIO_SENDS_MOST)
        return fio_fail(FIO_USAGE, "%s: more than %d commands; give them to --console",
                        given->written, FIO_SENDS_MOST);
    for (const char *c = given->value; *c; c++)
        if ((unsigned char)*c < ' ' && *c != '\t')
            return fail_value(given, "one command without line ends");
    arguments->send[arguments->send_count++] = given->value;
    return FIO_OK;
}

/* ---- what flags mean ---- */

static void read_switch(fio_arguments *arguments, flag_number flag) {
    bool *const switches[FLAG_NUMBERS] = {
        [FLAG_no_reset] = &arguments->no_reset,
        [FLAG_probe] = &arguments->probe,
        [FLAG_heaters_off] = &arguments->heaters_off,
        [FLAG_yes] = &arguments->yes,
        [FLAG_start] = &arguments->start,
        [FLAG_json] = &arguments->json,
        [FLAG_quiet] = &arguments->quiet,
    };
    *switches[flag] = true;
}

static fio_status read_flag(fio_arguments *arguments, const given_flag *given) {
    const char **const texts[FLAG_NUMBERS] = {
        [FLAG_port] = &arguments->port,
        [FLAG_firmware] = &arguments->firmware,
        [FLAG_journal] = &arguments->journal,
        [FLAG_resume_from] = &arguments->resume_from,
        [FLAG_on_pause] = &arguments->on_pause,
        [FLAG_on_cancel] = &arguments->on_cancel,
        [FLAG_virtual] = &arguments->virtual_options,
        [FLAG_log] = &arguments->log,
    };
    if (texts[given->flag]) {
        *texts[given->flag] = given->value;
        return FIO_OK;
    }
    switch (given->flag) {
    case FLAG_baud:
        return read_baud(arguments, given);
    case FLAG_wait:
        return read_wait(arguments, given);
    case FLAG_window:
        return read_window(arguments, given);
    case FLAG_bed:
        return read_bed(arguments, given);
    case FLAG_upload:
        return read_upload(arguments, given);
    case FLAG_send:
        return read_send(arguments, given);
    default:
        read_switch(arguments, given->flag);
        return FIO_OK;
    }
}

/* Flags that say what is to be done; two of them contradict each other. */
static const struct {
    flag_number flag;
    fio_work work;
} work_flags[] = {
    {FLAG_help, FIO_WORK_HELP},     {FLAG_version, FIO_WORK_VERSION}, {FLAG_man, FIO_WORK_MAN},
    {FLAG_list, FIO_WORK_LIST},     {FLAG_console, FIO_WORK_CONSOLE}, {FLAG_send, FIO_WORK_SEND},
    {FLAG_dry_run, FIO_WORK_CHECK}, {FLAG_upload, FIO_WORK_UPLOAD},
};

typedef struct chosen_work {
    fio_work work;
    char written[48]; /* the flag that chose it */
} chosen_work;

/* True if the flag says nothing more than which work is wanted. */
static fio_status choose_work(chosen_work *chosen, const given_flag *given, bool *done) {
    *done = false;
    for (size_t i = 0; i < sizeof work_flags / sizeof *work_flags; i++) {
        fio_work work = work_flags[i].work;
        if (work_flags[i].flag != given->flag)
            continue;
        *done = work != FIO_WORK_SEND && work != FIO_WORK_UPLOAD;
        if (chosen->work >= FIO_WORK_HELP)
            return FIO_OK; /* whatever else there is */
        if (work < FIO_WORK_HELP && chosen->work != FIO_WORK_PRINT && chosen->work != work)
            return fio_fail(FIO_USAGE, "%s and %s don't go together", chosen->written,
                            given->written);
        chosen->work = work;
        memcpy(chosen->written, given->written, sizeof given->written);
    }
    return FIO_OK;
}

static bool takes_file(fio_work work) {
    return work == FIO_WORK_PRINT || work == FIO_WORK_UPLOAD || work == FIO_WORK_CHECK;
}

static fio_status check(const fio_arguments *arguments, const chosen_work *chosen) {
    fio_work work = arguments->work;
    if (work >= FIO_WORK_HELP)
        return FIO_OK;
    if (arguments->file && !takes_file(work))
        return fio_fail(FIO_USAGE, "%.60s: %s takes no file", arguments->file, chosen->written);
    if (!arguments->file && takes_file(work) && !(work == FIO_WORK_PRINT && arguments->resume_from))
        return fio_fail(FIO_USAGE, "no file given; see isoprint --help");
    if (arguments->probe && work != FIO_WORK_LIST)
        return fio_fail(FIO_USAGE, "--probe goes with --list alone");
    if (arguments->bed[0] > 0 && work != FIO_WORK_CHECK)
        return fio_fail(FIO_USAGE, "--bed goes with --dry-run alone");
    if (arguments->start && work != FIO_WORK_UPLOAD)
        return fio_fail(FIO_USAGE, "--start goes with --upload alone");
    if (arguments->resume_from && work != FIO_WORK_PRINT)
        return fio_fail(FIO_USAGE, "--resume-from and %s don't go together", chosen->written);
    return FIO_OK;
}

fio_status fio_arguments_read(fio_arguments *arguments, int argc, char **argv) {
    *arguments = (fio_arguments){.baud = 115200};
    walk along = {.argv = argv, .argc = argc, .at = 1};
    chosen_work chosen = {.work = FIO_WORK_PRINT};
    while (along.at < argc) {
        const char *text = argv[along.at++];
        if (!along.files_only && !strcmp(text, "--")) {
            along.files_only = true;
        } else if (along.files_only || text[0] != '-' || !text[1]) {
            if (arguments->file)
                return fio_fail(FIO_USAGE, "more than one file given: %.60s and %.60s",
                                arguments->file, text);
            arguments->file = text;
        } else {
            given_flag given;
            bool done;
            fio_status status = next_flag(&along, &given, text);
            if (status == FIO_OK)
                status = choose_work(&chosen, &given, &done);
            if (status == FIO_OK && !done)
                status = read_flag(arguments, &given);
            if (status != FIO_OK)
                return status;
        }
    }
    arguments->work = chosen.work;
    return check(arguments, &chosen);
}
