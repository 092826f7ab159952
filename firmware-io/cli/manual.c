/* What the program prints about itself: help, version, the manual page. */
#include <stdio.h>
#include <string.h>

#include "arguments.h"

static const char *const usage[] = {
    "isoprint part.gcode [--port PORT] [--baud RATE] [options]",
    "isoslice part.stl -o - | isoprint - [options]",
    "isoprint part.gcode --upload NAME [--start] [options]",
    "isoprint --resume-from part.gcode.journal",
    "isoprint part.gcode --dry-run [--bed XxYxZ]",
    "isoprint --send COMMAND [options]",
    "isoprint --console [options]",
    "isoprint --list [--probe] [--json]",
};

enum { USAGES = sizeof usage / sizeof *usage };

static const char purpose[] =
    "Send G-code to a 3D printer over USB, a serial device or a socket, every command once and in "
    "order, and see the print through to its end.";

static const struct {
    const char *key, *meaning;
} keys[] = {
    {"p", "Pause: the moves under way are finished, then the nozzle is lifted off the part."},
    {"r", "Resume. Also lets a printer go on that waits for somebody (M0, M600)."},
    {"c", "Cancel, if pressed twice within 5 s: heaters off, then the end."},
    {"!", "Emergency stop (M112): the next thing the printer hears, whatever waits."},
    {"?", "What the keys do."},
};

static const struct {
    const char *name, *meaning;
} signals[] = {
    {"SIGINT (Ctrl-C)", "The first cancels the job and switches the heaters off; the second is an "
                        "emergency stop; the third leaves at once."},
    {"SIGTERM, SIGHUP", "Cancel the job and switch the heaters off."},
    {"SIGQUIT (Ctrl-\\)", "An emergency stop."},
    {"SIGTSTP (Ctrl-Z)", "Refused while a job runs: the nozzle would stand still on the part."},
};

static const struct {
    int code;
    const char *meaning;
} exit_codes[] = {
    {FIO_OK, "Done: the printer has every command, and has made every move."},
    {FIO_USAGE, "A command line that makes no sense; nothing was sent."},
    {FIO_UNREADABLE, "A file that can't be read, is no G-code, or holds no command."},
    {FIO_NOT_WRITTEN, "Output that could not be written: the log, the journal, standard output."},
    {FIO_FAULTY, "The job holds what a job must not do, or the printer refused or halted."},
    {FIO_NO_PRINTER, "No such port, it may not be opened, or nothing answers there."},
    {FIO_LINK_LOST, "The printer went away, restarted or fell silent in the middle of the job."},
    {FIO_CANCELLED, "Stopped by its user."},
    {FIO_NO_MEMORY, "Not enough memory."},
    {FIO_BUG, "A defect of isoprint."},
};

enum {
    KEYS = sizeof keys / sizeof *keys,
    SIGNALS = sizeof signals / sizeof *signals,
    EXIT_CODES = sizeof exit_codes / sizeof *exit_codes
};

/* "-p, --port PORT" */
static const char *flag_text(char text[96], const fio_flag_info *flag, const char *no_letter) {
    char name[32], letter[8];
    snprintf(name, sizeof name, "%s", flag->name);
    for (char *c = name; *c; c++)
        *c = *c == '_' ? '-' : *c;
    snprintf(letter, sizeof letter, "-%c, ", flag->letter);
    snprintf(text, 96, "%s--%s%s%s", flag->letter ? letter : no_letter, name,
             *flag->argument ? " " : "", flag->argument);
    return text;
}

/* Words broken before `width` columns, the lines behind the first indented. */
static int print_words(const char *text, int column, int indent, int width) {
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
    return column;
}

static void print_entry(const char *name, const char *help, const char *range) {
    enum { INDENT = 31, WIDTH = 100 };
    char bracketed[128];
    if (strlen(name) > 28)
        printf("  %s\n%*s", name, INDENT, "");
    else
        printf("  %-28s ", name);
    int column = print_words(help, INDENT, INDENT, WIDTH);
    snprintf(bracketed, sizeof bracketed, "(%s)", range);
    if (*range)
        print_words(bracketed, column, INDENT, WIDTH);
    putchar('\n');
}

static void print_help(void) {
    for (int i = 0; i < USAGES; i++)
        printf("%s %s\n", i == 0 ? "usage:" : "      ", usage[i]);
    putchar('\n');
    print_words(purpose, 0, 0, 100);
    putchar('\n');
    for (int i = 0; i < fio_flag_count(); i++) {
        const fio_flag_info *flag = fio_flag_at(i);
        char text[96];
        if (!flag->name)
            printf("\n%s:\n", flag->help);
        else
            print_entry(flag_text(text, flag, "    "), flag->help, flag->range);
    }
    printf("\nKeys while a job runs:\n");
    for (int i = 0; i < KEYS; i++)
        print_entry(keys[i].key, keys[i].meaning, "");
    printf("\nSignals:\n");
    for (int i = 0; i < SIGNALS; i++)
        print_entry(signals[i].name, signals[i].meaning, "");
    printf("\nExit codes:\n");
    for (int i = 0; i < EXIT_CODES; i++) {
        char code[16];
        snprintf(code, sizeof code, "%d", exit_codes[i].code);
        print_entry(code, exit_codes[i].meaning, "");
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

static void man_entry(const char *name, const char *meaning) {
    printf(".TP\n");
    print_roff(name);
    print_roff(meaning);
}

static void man_flags(void) {
    printf(".SH OPTIONS\n");
    for (int i = 0; i < fio_flag_count(); i++) {
        const fio_flag_info *flag = fio_flag_at(i);
        char text[96], range[128];
        if (!flag->name) {
            printf(".SS %s\n", flag->help);
            continue;
        }
        man_entry(flag_text(text, flag, ""), flag->help);
        snprintf(range, sizeof range, "(%s)", flag->range);
        if (*flag->range)
            print_roff(range);
    }
}

static void man_description(void) {
    printf(".SH DESCRIPTION\n");
    print_roff(purpose);
    printf(".PP\n");
    print_roff("The job is looked through before anything is sent. Its lines go out numbered and "
               "with a checksum, as many at a time as the firmware has room for; what was damaged "
               "on the way is sent again. If the printer goes away, restarts or falls silent, "
               "isoprint stops, says where, and names the command that goes on with the job.");
    printf(".PP\n");
    print_roff("On a terminal a line shows how far the job is; elsewhere there is a line every 10 "
               "%. Messages go to standard error, answers and JSON to standard output.");
}

static void print_man(void) {
    printf(".TH ISOPRINT 1 \"\" \"isoprint %s\" \"User Commands\"\n", FIO_VERSION);
    printf(".SH NAME\nisoprint \\- send G-code to 3D printers\n.SH SYNOPSIS\n.nf\n");
    for (int i = 0; i < USAGES; i++)
        print_roff(usage[i]);
    printf(".fi\n");
    man_description();
    man_flags();
    printf(".SH KEYS\n");
    for (int i = 0; i < KEYS; i++)
        man_entry(keys[i].key, keys[i].meaning);
    printf(".SH SIGNALS\n");
    for (int i = 0; i < SIGNALS; i++)
        man_entry(signals[i].name, signals[i].meaning);
    printf(".SH EXIT STATUS\n");
    for (int i = 0; i < EXIT_CODES; i++) {
        printf(".TP\n%d\n", exit_codes[i].code);
        print_roff(exit_codes[i].meaning);
    }
    printf(".SH ENVIRONMENT\n");
    man_entry("ISOPRINT_PORT", "The port where --port is not given.");
    printf(".SH FILES\n");
    man_entry("part.gcode.journal",
              "How far the job part.gcode came: written beside it, removed when it is done.");
    printf(".SH EXAMPLES\n.nf\n");
    print_roff("isoprint --list");
    print_roff("isoprint part.gcode");
    print_roff("isoprint part.gcode --port tty:/dev/ttyUSB0 --baud 250000 --log part.log");
    print_roff("isoslice part.stl -o - | isoprint -");
    print_roff("isoprint --send M503");
    print_roff("isoprint part.gcode --port virtual");
    printf(".fi\n.SH SEE ALSO\n.BR isoslice (1)\n");
}

void fio_page_print(fio_work work) {
    if (work == FIO_WORK_HELP)
        print_help();
    else if (work == FIO_WORK_VERSION)
        printf("isoprint %s\n", FIO_VERSION);
    else
        print_man();
}
