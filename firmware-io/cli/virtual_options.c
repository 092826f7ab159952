#include "virtual_options.h"

#include <stddef.h>
#include <string.h>

#include "base/number.h"
#include "base/text.h"

typedef enum kind { TEXT, LINK, NUMBER, COUNT, SMALL, FLAG, UNFLAG, AXES, CORNER, ID, SPEED } kind;

typedef struct option {
    const char *name; /* NULL: the title of a group */
    kind kind;
    size_t at;
    double least, most;
    const char *value, *help;
} option;

static const option options[] = {
#define VIRTUAL_GROUP(title) {NULL, TEXT, 0, 0, 0, NULL, title},
#define VIRTUAL_OPTION(name, kind, member, least, most, value, help)                               \
    {name, kind, offsetof(virtual_arguments, member), least, (double)most, value, help},
#include "virtual_options.inl"
};

enum { OPTIONS = sizeof options / sizeof *options };

/* "what it is; 0 to 1" */
static const char *describe(char bytes[200], const option *of) {
    fio_text text = fio_text_in(bytes, 200);
    fio_text_string(&text, of->help);
    if ((of->kind == NUMBER || of->kind == COUNT || of->kind == SMALL) && of->most < 1e9) {
        fio_text_string(&text, "; ");
        fio_text_number(&text, of->least, of->least > 0 && of->least < 1 ? 3 : 0);
        fio_text_string(&text, " to ");
        fio_text_number(&text, of->most, 0);
    }
    return bytes;
}

/* "--name VALUE   what it is; 0 to 1" */
static void print_option(const option *of) {
    char bytes[200], help[200];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, of->name);
    fio_text_string(&text, " ");
    fio_text_string(&text, of->value ? of->value : "");
    printf("  %-29s %s\n", bytes, describe(help, of));
}

static void print_help(void) {
    fputs(
        "isoprint-virtual --run FILE [OPTIONS]\n"
        "isoprint-virtual --pty|--socket|--tcp|--usb|--usbip|--usbip-attach ... [OPTIONS] "
        "[-- COMMAND...]\n"
        "A printer that exists only in memory, and says what happened to it. COMMAND is run with\n"
        "what to open in the variable ISOPRINT_PORT; the printer ends with it.\n",
        stdout);
    for (int i = 0; i < OPTIONS; i++)
        if (!options[i].name)
            printf("\n%s:\n", options[i].help);
        else
            print_option(&options[i]);
    fputs("\nOther:\n  --help, --version\n"
          "\n"
          "CHIP: cdc-acm, ch340, ch340-limited, ftdi, ftdi-h, cp2102, pl2303hx, pl2303hxn.\n"
          "Exit codes: 0 no fault, 2 usage, 3 unreadable, 7 output not written or nothing to stand "
          "at,\n8 faults, or executed lines that differ from --check. With a COMMAND: its own if "
          "that is not 0\n(128 and the signal's number if one ended it).\n",
          stdout);
}

/* `count` numbers parted by the character `between`, and nothing else. */
static bool read_numbers(double *values, int count, char between, const char *text) {
    const char *end = text + strlen(text);
    for (int i = 0; i < count; i++) {
        const char *after = fio_number_read(&values[i], text, end);
        if (after == text || (i < count - 1 && *after != between))
            return false;
        text = i < count - 1 ? after + 1 : after;
    }
    return text == end;
}

static bool read_whole(int64_t *value, const char *text, double least, double most) {
    int64_t read = 0;
    if (!*text)
        return false;
    for (; *text; text++) {
        if (*text < '0' || *text > '9' || read > (INT64_MAX - 9) / 10)
            return false;
        read = read * 10 + (*text - '0');
    }
    *value = read;
    return (double)read >= least && (double)read <= most;
}

static bool read_id(uint16_t *id, const char *text) {
    static const char digits[] = "0123456789abcdef";
    for (int i = 0; i < 2; i++) {
        unsigned value = 0;
        for (int k = 0; k < 4; k++, text++) {
            char lower = *text >= 'A' && *text <= 'F' ? (char)(*text + 32) : *text;
            const char *at = lower ? strchr(digits, lower) : NULL;
            if (!at)
                return false;
            value = value * 16 + (unsigned)(at - digits);
        }
        id[i] = (uint16_t)value;
        if (*text++ != (i ? 0 : ':'))
            return false;
    }
    return true;
}

static bool read_range(double *values, int count, char between, const option *of,
                       const char *text) {
    double read[3];
    if (!read_numbers(read, count, between, text))
        return false;
    for (int i = 0; i < count; i++)
        if (!(read[i] >= of->least && read[i] <= of->most))
            return false;
    memcpy(values, read, (size_t)count * sizeof *read);
    return true;
}

static bool read_speed(double *speed, const option *of, const char *text) {
    if (!strcmp(text, "real") || !strcmp(text, "instant"))
        return *speed = *text == 'r' ? 1 : 0, true;
    return read_range(speed, 1, 0, of, text) && *speed > 0;
}

static bool read_value(void *to, const option *of, const char *text) {
    int64_t whole;
    switch (of->kind) {
    case TEXT:
    case LINK:
        *(const char **)to = text;
        return *text || of->kind == LINK;
    case NUMBER:
        return read_range(to, 1, 0, of, text);
    case AXES:
        return read_range(to, 3, 'x', of, text);
    case CORNER:
        return read_range(to, 3, ',', of, text);
    case COUNT:
        return read_whole(to, text, of->least, of->most);
    case SMALL:
        return read_whole(&whole, text, of->least, of->most) && (*(int *)to = (int)whole, true);
    case ID:
        return read_id(to, text);
    case SPEED:
        return read_speed(to, of, text);
    case FLAG:
    case UNFLAG:
        break;
    }
    return false;
}

/* The value of "--name value" or "--name=value"; "" if there is none where one may be left out. */
static const char *value_of(const option *of, size_t length, char **argv, int *i) {
    if (argv[*i][length] == '=')
        return argv[*i] + length + 1;
    const char *following = argv[*i + 1];
    if (!following || (of->kind == LINK && *following == '-'))
        return of->kind == LINK ? "" : NULL;
    return argv[++*i];
}

static fio_status read_option(virtual_arguments *given, char **argv, int *i) {
    const char *name = argv[*i];
    char help[200];
    size_t length = strcspn(name, "=");
    for (const option *of = options; of < options + OPTIONS; of++) {
        if (!of->name || strlen(of->name) != length || strncmp(of->name, name, length) != 0)
            continue;
        void *to = (char *)given + of->at;
        if (of->kind == FLAG || of->kind == UNFLAG) {
            if (name[length])
                return fio_fail(FIO_USAGE, "%s takes no value", of->name);
            *(bool *)to = of->kind == FLAG;
            return FIO_OK;
        }
        const char *value = value_of(of, length, argv, i);
        if (!value)
            return fio_fail(FIO_USAGE, "%s needs a value: %s, %s", of->name, of->value,
                            describe(help, of));
        if (read_value(to, of, value))
            return FIO_OK;
        return fio_fail(FIO_USAGE, "%s can't be '%s': %s, %s", of->name, value, of->value,
                        describe(help, of));
    }
    return fio_fail(FIO_USAGE, "%s: no such option", name);
}

static fio_status make_sense(const virtual_arguments *given) {
    const char *const ways[] = {given->run, given->pty,   given->socket, given->tcp,
                                given->usb, given->usbip, given->vhci};
    int count = 0;
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++)
        count += ways[i] != NULL;
    if (count != 1)
        return fio_fail(FIO_USAGE,
                        "%s: give one of --run, --pty, --socket, --tcp, --usb, --usbip "
                        "and --usbip-attach",
                        count ? "only one at a time" : "what shall it do");
    if (given->run && given->command)
        return fio_fail(FIO_USAGE, "--run needs no COMMAND: it reads the file itself");
    if (given->usb && !given->command)
        return fio_fail(FIO_USAGE, "--usb needs a COMMAND that sees the device: -- COMMAND...");
    return FIO_OK;
}

fio_status virtual_arguments_read(virtual_arguments *given, char **argv) {
    *given = (virtual_arguments){.machine = fio_machine_options_defaults(),
                                 .speed = 1,
                                 .replug = -1,
                                 .usb_stall = -1,
                                 .usbip_port = "3240"};
    for (int i = 1; argv[i]; i++) {
        if (!strcmp(argv[i], "--help") || !strcmp(argv[i], "--version")) {
            if (argv[i][2] == 'h')
                print_help();
            else
                puts("isoprint-virtual " FIO_VERSION);
            given->done = true;
            return FIO_OK;
        }
        if (!strcmp(argv[i], "--")) {
            given->command = argv[i + 1] ? argv + i + 1 : NULL;
            break;
        }
        fio_status status = read_option(given, argv, &i);
        if (status != FIO_OK)
            return status;
    }
    given->machine.seed = (uint64_t)given->seed;
    return make_sense(given);
}
