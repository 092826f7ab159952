/* Reading jobs: every way in gives the same commands, equal to those of a reader that is too simple
 * to be wrong. */
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "check.h"
#include "protocol/source.h"

static uint64_t random_state = 5;

static unsigned random_below(unsigned bound) {
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return (unsigned)(random_state % bound);
}

enum { COMMANDS_MOST = 4000 };

typedef struct listing {
    int count;
    fio_source_result end;
    char text[COMMANDS_MOST][128];
    int64_t line[COMMANDS_MOST], offset[COMMANDS_MOST];
    int32_t layer[COMMANDS_MOST];
} listing;

static void list(listing *l, fio_source *source) {
    fio_source_command command;
    l->count = 0;
    while ((l->end = fio_source_next(source, &command)) == FIO_SOURCE_COMMAND) {
        CHECK_EQUAL(l->count, command.index);
        CHECK(command.length > 0 && command.length == strlen(command.text));
        if (l->count == COMMANDS_MOST)
            return;
        snprintf(l->text[l->count], sizeof *l->text, "%s", command.text);
        l->line[l->count] = command.line;
        l->offset[l->count] = command.offset;
        l->layer[l->count++] = command.layer;
    }
}

static fio_source *in_memory(const char *bytes, size_t size) {
    fio_source *source = NULL;
    CHECK_EQUAL(FIO_OK, fio_source_memory(&source, bytes, size));
    return source;
}

/* A file that is gone once it is opened. */
static fio_source *in_file(const char *bytes, size_t size) {
    char path[] = "/tmp/test-source-XXXXXX";
    int descriptor = mkstemp(path);
    fio_source *source = NULL;
    CHECK(descriptor >= 0 && write(descriptor, bytes, size) == (ssize_t)size);
    CHECK_EQUAL(FIO_OK, fio_source_open(&source, path));
    close(descriptor);
    unlink(path);
    return source;
}

static bool same(const listing *a, const listing *b) {
    bool equal = a->count == b->count && a->end == b->end;
    for (int i = 0; equal && i < a->count; i++)
        equal = strcmp(a->text[i], b->text[i]) == 0 && a->line[i] == b->line[i] &&
                a->offset[i] == b->offset[i] && a->layer[i] == b->layer[i];
    return equal;
}

/* A pipe in the place of standard input, written in pieces. */
static void list_pipe(listing *l, const char *bytes, size_t size) {
    int ends[2], before = dup(STDIN_FILENO);
    CHECK(pipe(ends) == 0 && dup2(ends[0], STDIN_FILENO) == STDIN_FILENO);
    close(ends[0]);
    fio_source *source = NULL;
    fio_source_command command;
    CHECK_EQUAL(FIO_OK, fio_source_open(&source, "-"));
    CHECK_EQUAL(STDIN_FILENO, fio_source_descriptor(source));
    CHECK(fio_source_seek(source, 0) == FIO_USAGE && fio_source_fingerprint(source) == 0);
    size_t written = 0;
    l->count = 0;
    do {
        l->end = fio_source_next(source, &command);
        if (l->end == FIO_SOURCE_COMMAND && l->count < COMMANDS_MOST) {
            snprintf(l->text[l->count], sizeof *l->text, "%s", command.text);
            l->line[l->count] = command.line;
            l->offset[l->count] = command.offset;
            l->layer[l->count++] = command.layer;
        }
        if (l->end != FIO_SOURCE_LATER)
            continue;
        size_t piece = 1 + random_below(20);
        piece = piece < size - written ? piece : size - written;
        if (piece > 0)
            CHECK(write(ends[1], bytes + written, piece) == (ssize_t)piece);
        else
            close(ends[1]);
        written += piece;
    } while (l->end == FIO_SOURCE_COMMAND || l->end == FIO_SOURCE_LATER);
    fio_source_close(source);
    dup2(before, STDIN_FILENO);
    close(before);
}

static const char small[] = "\xef\xbb\xbf; made by hand\r\n"
                            "G28 ; home\r\n"
                            "\r\n"
                            "  M117 Hello (not this) there ; nor this\r\n"
                            ";LAYER_CHANGE\r\n"
                            ";Z:0.2\r\n"
                            "N12 G1 X1 Y2*57\r\n"
                            "G1 X2*93\n"
                            "%\n"
                            "N13\n"
                            "n14\tG1 X3 \t\n"
                            "(a comment) G1 (X9) X4(\n"
                            " ;LAYER_CHANGE with a blank before it counts for nothing\n"
                            "G1 X5;LAYER_CHANGE nor does this\n"
                            ";LAYER:7 is another slicer's\n"
                            ";LAYER_CHANGE\n"
                            "M117 2*3\n"
                            "N15 M117 2*3*44\n"
                            "NOZZLE_WIPE\rM84\r\rG4 P1\n\r\nG1 X6";

static const struct {
    const char *text;
    int line, layer;
} small_commands[] = {
    {"G28", 2, 0},       {"M117 Hello  there", 4, 0}, {"G1 X1 Y2", 7, 1}, {"G1 X2", 8, 1},
    {"G1 X3", 11, 1},    {"G1  X4", 12, 1},           {"G1 X5", 14, 1},   {"M117 2*3", 17, 2},
    {"M117 2*3", 18, 2}, {"NOZZLE_WIPE", 19, 2},      {"M84", 20, 2},     {"G4 P1", 22, 2},
    {"G1 X6", 24, 2},
};
enum { SMALL = sizeof small_commands / sizeof *small_commands };

static void check_small(const listing *l) {
    CHECK_EQUAL(FIO_SOURCE_END, l->end);
    CHECK_EQUAL(SMALL, l->count);
    for (int i = 0; i < SMALL && i < l->count; i++) {
        bool right = strcmp(small_commands[i].text, l->text[i]) == 0;
        right = CHECK_EQUAL(small_commands[i].line, l->line[i]) && right;
        right = CHECK_EQUAL(small_commands[i].layer, l->layer[i]) && right;
        if (!CHECK(right))
            fprintf(stderr, "    %s, not %s\n", l->text[i], small_commands[i].text);
    }
}

static void test_small_job(void) {
    static listing memory, file, piped;
    size_t size = strlen(small);
    fio_source *source = in_memory(small, size);
    CHECK_EQUAL(-1, fio_source_descriptor(source));
    list(&memory, source);
    check_small(&memory);
    fio_source_command command;
    CHECK_EQUAL(FIO_SOURCE_END, fio_source_next(source, &command)); /* and for ever */
    CHECK_EQUAL(size, memory.offset[SMALL - 1]);
    CHECK_EQUAL(strstr(small, "\r\n  M117") + 2 - small, strstr(small, "  M117") - small);
    CHECK_EQUAL(strstr(small, "\r\n  M117") - small, memory.offset[0]);
    CHECK_EQUAL(2, fio_source_whole(source)->layers);
    CHECK_EQUAL(size, fio_source_whole(source)->bytes);
    CHECK_NEAR(-1, fio_source_whole(source)->seconds, 0);
    fio_source_close(source);
    source = in_file(small, size);
    CHECK_EQUAL(-1, fio_source_descriptor(source));
    list(&file, source);
    CHECK(same(&memory, &file));
    CHECK_EQUAL(2, fio_source_whole(source)->layers);
    fio_source_close(source);
    for (int round = 0; round < 20; round++) {
        list_pipe(&piped, small, size);
        CHECK(same(&memory, &piped));
    }
}

/* A reader in the plainest way: whole text, line by line. */
static void list_plainly(listing *l, const char *bytes, size_t size) {
    l->count = 0;
    l->end = FIO_SOURCE_END;
    int64_t line = 0;
    int32_t layer = 0;
    for (size_t at = 0; at < size;) {
        size_t end = at;
        while (end < size && bytes[end] != '\n' && bytes[end] != '\r')
            end++;
        size_t next = end + 1;
        if (end + 1 < size && bytes[end] == '\r' && bytes[end + 1] == '\n')
            next++;
        line++;
        char text[4096];
        size_t length = 0;
        bool inside = false;
        for (size_t i = at; i < end && (inside || bytes[i] != ';'); i++) {
            bool mark = inside ? bytes[i] == ')' : bytes[i] == '(';
            if (!inside && !mark)
                text[length++] = bytes[i];
            inside = mark ? !inside : inside;
        }
        layer += end - at >= 13 && memcmp(bytes + at, ";LAYER_CHANGE", 13) == 0;
        while (length > 0 && (text[length - 1] == ' ' || text[length - 1] == '\t'))
            length--;
        text[length] = 0;
        const char *start = text + strspn(text, " \t");
        if (*start && strcmp(start, "%") != 0 && l->count < COMMANDS_MOST) {
            snprintf(l->text[l->count], sizeof *l->text, "%s", start);
            l->line[l->count] = line;
            l->layer[l->count] = layer;
            l->offset[l->count++] = (int64_t)(next < size ? next : size);
        }
        at = next;
    }
}

static size_t random_job(char *bytes, size_t most) {
    static const char *const pieces[] = {"G1",
                                         " ",
                                         "X12.5",
                                         "Y-3",
                                         "\n",
                                         "\r",
                                         "\r\n",
                                         ";",
                                         "(",
                                         ")",
                                         "M117",
                                         "\n",
                                         "\t",
                                         "\n\n",
                                         "\n;LAYER",
                                         ";LAYER_CHANGE",
                                         "%",
                                         "\nG28",
                                         "a;b)",
                                         "E.5",
                                         "\n(",
                                         "F30",
                                         "T0",
                                         "\xc3\xa4",
                                         "\n;LAYER_CHANGE",
                                         "\r\n;"};
    size_t size = 0;
    while (size + 20 < most) {
        const char *piece = pieces[random_below(sizeof pieces / sizeof *pieces)];
        memcpy(bytes + size, piece, strlen(piece));
        size += strlen(piece);
    }
    return size;
}

/* Any bytes: memory, file and pipe agree with the plain reader, and so does the count of layers. */
static void test_random_jobs(void) {
    static char bytes[20000];
    static listing plain, memory, other;
    for (int round = 0; round < 200; round++) {
        size_t size = random_job(bytes, round % 5 ? 50 + random_below(2000) : sizeof bytes);
        list_plainly(&plain, bytes, size);
        fio_source *source = in_memory(bytes, size);
        list(&memory, source);
        int32_t layers = fio_source_whole(source)->layers, passed = 0;
        for (size_t i = 0; i + 13 <= size; i++) {
            bool begins = i == 0 || bytes[i - 1] == '\n' || bytes[i - 1] == '\r';
            passed += begins && memcmp(bytes + i, ";LAYER_CHANGE", 13) == 0;
        }
        CHECK_EQUAL(passed > 0 ? passed : -1, layers);
        fio_source_close(source);
        if (round % 10 == 0)
            list_pipe(&other, bytes, size);
        else {
            source = in_file(bytes, size);
            list(&other, source);
            fio_source_close(source);
        }
        if (!CHECK(same(&plain, &memory) && same(&memory, &other))) {
            fprintf(stderr, "    round %d\n", round);
            break;
        }
    }
}

/* Layer marks across the blocks of the survey, wherever they fall. */
static void test_layers_of_large_jobs(void) {
    enum { SIZE = 300000 };
    static char bytes[SIZE + 64];
    static const char *const marks[] = {";LAYER_CHANGE\n", ";LAYER:12\n", "; CHANGE_LAYER\n"};
    for (int round = 0; round < 12; round++) {
        const char *mark = marks[round % 3];
        size_t size = 0;
        int layers = 0;
        while (size < SIZE) {
            bool near = (size + 40) % 65536 < 60 || random_below(50) == 0;
            size_t pad = near ? random_below(12) : 20 + random_below(30);
            bytes[size++] = 'G';
            memset(bytes + size, '1', pad);
            size += pad;
            bytes[size++] = '\n';
            if (!near)
                continue;
            memcpy(bytes + size, mark, strlen(mark));
            size += strlen(mark);
            layers++;
        }
        fio_source *source = in_memory(bytes, size);
        fio_source_command command;
        CHECK_EQUAL(layers, fio_source_whole(source)->layers);
        int32_t last = 0;
        while (fio_source_next(source, &command) == FIO_SOURCE_COMMAND)
            last = command.layer;
        CHECK(last == layers || last == layers - 1);
        fio_source_close(source);
    }
}

static void test_seconds(void) {
    static const struct {
        const char *text;
        double seconds;
    } jobs[] = {
        {"G28\n; estimated printing time (normal mode) = 1d 2h 3m 4s\n", 93784},
        {"G28\n; estimated printing time (normal mode) = 45s\n", 45},
        {"; estimated printing time = 2h 0m 1s\nG28", 7201},
        {";FLAVOR:Marlin\n;TIME:6666\n;LAYER_COUNT:3\nG28", 6666},
        {";TIME:12.5\nG28\n;TIME_ELAPSED:99\n", 12.5},
        {"; model printing time: 1h 2m 3s; total estimated time: 1h 5m 3s\nG28", 3903},
        {"G28\nM73 P0 R90\nM73 P50 R45\n", -1}, /* known only when it comes */
        {"; estimated printing time (normal mode) = soon\n", -1},
        {"; estimated printing time (normal mode) = 5x\n", -1},
        {";TIME:-5\n", -1},
        {"", -1},
    };
    static char large[200000];
    memset(large, 'G', sizeof large);
    for (size_t i = 0; i < sizeof large; i += 20)
        large[i] = '\n';
    for (size_t i = 0; i < sizeof jobs / sizeof *jobs; i++) {
        fio_source *source = in_memory(jobs[i].text, strlen(jobs[i].text));
        CHECK_NEAR(jobs[i].seconds, fio_source_whole(source)->seconds, 0);
        fio_source_close(source);
        /* At the end of a large file. */
        size_t length = strlen(jobs[i].text);
        memcpy(large + sizeof large - length, jobs[i].text, length);
        large[sizeof large - length - 1] = '\n';
        source = in_file(large, sizeof large);
        CHECK_NEAR(jobs[i].seconds, fio_source_whole(source)->seconds, 0);
        fio_source_close(source);
        memset(large + sizeof large - length, '\n', length);
    }
    static const char progress[] = "G28\nM73 P0 R90\nM73 P50 R45\nG1";
    fio_source *source = in_memory(progress, strlen(progress));
    fio_source_command command;
    while (fio_source_next(source, &command) == FIO_SOURCE_COMMAND)
        ;
    CHECK_NEAR(5400, fio_source_whole(source)->seconds, 0);
    fio_source_close(source);
}

static void expect_failure(const char *bytes, size_t size, int commands, const char *line,
                           const char *why) {
    static listing l;
    for (int way = 0; way < 3; way++) {
        fio_source *source = way == 0 ? in_memory(bytes, size) : in_file(bytes, size);
        if (way < 2)
            list(&l, source);
        else
            list_pipe(&l, bytes, size < 60000 ? size : 60000);
        CHECK_EQUAL(FIO_SOURCE_FAILED, l.end);
        CHECK_EQUAL(commands, l.count);
        if (!CHECK(strstr(fio_error_message(), line) && strstr(fio_error_message(), why)))
            fprintf(stderr, "    %s\n", fio_error_message());
        fio_source_command command;
        if (way < 2)
            CHECK_EQUAL(FIO_SOURCE_FAILED, fio_source_next(source, &command));
        fio_source_close(source);
    }
}

static void test_what_is_no_job(void) {
    static char bytes[200000];
    memset(bytes, 'x', sizeof bytes);
    memcpy(bytes, "G28\nM84\nG1 ", 11);
    bytes[5000] = '\n';
    expect_failure(bytes, sizeof bytes, 2, "line 3:", "longer than 4095 bytes");
    expect_failure("G28\nG1 X\0Y\n", 11, 1, "line 2:", "no text");
    expect_failure("G28\nG1 X\bY\n", 11, 1, "line 2:", "no text");
    expect_failure("GCDE\1\0\0\0\1", 9, 0, "line 1:", "bgcode");
    expect_failure("\x1f\x8b\b\0\0", 5, 0, "line 1:", "gzip"); /* RFC 1952 */
    expect_failure("PK\3\4\24\0", 6, 0, "line 1:", "ZIP");
    expect_failure("\xff\xfeG\0"
                   "2\0",
                   6, 0, "line 1:", "UTF-16");
    fio_source *source = NULL;
    CHECK_EQUAL(FIO_UNREADABLE, fio_source_open(&source, "/nonexistent/part.gcode"));
    CHECK(source == NULL && strstr(fio_error_message(), "/nonexistent/part.gcode"));
    CHECK_EQUAL(FIO_UNREADABLE, fio_source_open(&source, "/"));
    CHECK(source == NULL && strstr(fio_error_message(), "folder"));
}

/* Just as long as it may be; and comments, which may be of any length and hold anything. */
static void test_long_lines(void) {
    static char bytes[300000];
    memset(bytes, ' ', sizeof bytes);
    memcpy(bytes + 9000, "G1 ", 3); /* blanks before it do not count */
    memset(bytes + 9003, 'X', 4092);
    memcpy(bytes + 9003 + 4092, "\n;", 2);
    memset(bytes + 13200, 0, 200000);
    memcpy(bytes + 250000, "\nG28(", 5);
    memset(bytes + 250005, 1, 40000);
    fio_source *source = in_memory(bytes, sizeof bytes);
    fio_source_command command;
    CHECK_EQUAL(FIO_SOURCE_COMMAND, fio_source_next(source, &command));
    CHECK_EQUAL(4095, command.length);
    CHECK_EQUAL(FIO_SOURCE_COMMAND, fio_source_next(source, &command));
    CHECK(strcmp("G28", command.text) == 0);
    CHECK_EQUAL(3, command.line);
    CHECK_EQUAL(FIO_SOURCE_END, fio_source_next(source, &command));
    fio_source_close(source);
}

static void test_seek(void) {
    static char bytes[200000];
    static listing all;
    size_t size = random_job(bytes, 20000);
    fio_source *source = in_file(bytes, size);
    list(&all, source);
    CHECK(all.count > 100);
    for (int round = 0; round < 60; round++) {
        int index = (int)random_below((unsigned)all.count);
        fio_source_command command;
        CHECK_EQUAL(FIO_OK, fio_source_seek(source, index));
        CHECK_EQUAL(FIO_SOURCE_COMMAND, fio_source_next(source, &command));
        CHECK(command.index == index && command.line == all.line[index] &&
              command.offset == all.offset[index] && command.layer == all.layer[index] &&
              strncmp(command.text, all.text[index], 100) == 0);
    }
    fio_source_command command;
    CHECK_EQUAL(FIO_OK, fio_source_seek(source, all.count));
    CHECK_EQUAL(FIO_SOURCE_END, fio_source_next(source, &command));
    CHECK_EQUAL(FIO_USAGE, fio_source_seek(source, all.count + 1));
    CHECK_EQUAL(FIO_USAGE, fio_source_seek(source, -1));
    CHECK_EQUAL(FIO_OK, fio_source_seek(source, 0));
    fio_source_close(source);
}

/* A named pipe whose writer comes late, and goes. */
static void test_named_pipe(void) {
    char folder[] = "/tmp/test-source-XXXXXX", path[64];
    CHECK(mkdtemp(folder) != NULL);
    snprintf(path, sizeof path, "%s/job", folder);
    CHECK_EQUAL(0, mkfifo(path, 0600));
    fio_source *source = NULL;
    fio_source_command command;
    CHECK_EQUAL(FIO_OK, fio_source_open(&source, path));
    CHECK(fio_source_descriptor(source) > 2 && fio_source_whole(source)->bytes == -1);
    CHECK_EQUAL(FIO_SOURCE_LATER, fio_source_next(source, &command));
    int writer = open(path, O_WRONLY);
    CHECK_EQUAL(FIO_SOURCE_LATER, fio_source_next(source, &command));
    CHECK_EQUAL(8, write(writer, "G28\nG1 X", 8));
    CHECK_EQUAL(FIO_SOURCE_COMMAND, fio_source_next(source, &command));
    CHECK_EQUAL(FIO_SOURCE_LATER, fio_source_next(source, &command));
    CHECK_EQUAL(1, write(writer, "5", 1));
    CHECK_EQUAL(FIO_SOURCE_LATER, fio_source_next(source, &command));
    close(writer);
    CHECK_EQUAL(FIO_SOURCE_COMMAND, fio_source_next(source, &command));
    CHECK(strcmp(command.text, "G1 X5") == 0);
    CHECK_EQUAL(FIO_SOURCE_END, fio_source_next(source, &command));
    fio_source_close(source);
    unlink(path);
    rmdir(folder);
}

static void test_fingerprint(void) {
    static char bytes[300000];
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = "G1 X5\n"[i % 6];
    fio_source *source = in_memory(bytes, sizeof bytes), *other = in_file(bytes, sizeof bytes);
    uint64_t whole = fio_source_fingerprint(source);
    CHECK(whole != 0 && whole == fio_source_fingerprint(other));
    fio_source_close(source);
    fio_source_close(other);
    for (int change = 0; change < 4; change++) {
        size_t at = change == 0 ? 0 : change == 1 ? 65535 : sizeof bytes - 1;
        bytes[at] ^= 1;
        source = in_memory(bytes, sizeof bytes - (change == 3));
        CHECK(whole != fio_source_fingerprint(source));
        fio_source_close(source);
        bytes[at] ^= 1;
    }
}

static void test_no_memory(void) {
    fio_source *source = NULL;
    fio_fail_allocation_after(0);
    CHECK_EQUAL(FIO_NO_MEMORY, fio_source_memory(&source, "G28", 3));
    CHECK(source == NULL);
    CHECK_EQUAL(FIO_NO_MEMORY, fio_source_open(&source, "/dev/null"));
    CHECK(source == NULL);
    fio_fail_allocation_after(-1);
    fio_source_close(NULL);
    source = in_memory("", 0);
    fio_source_command command;
    CHECK_EQUAL(FIO_SOURCE_END, fio_source_next(source, &command));
    fio_source_close(source);
}

int main(void) {
    RUN(test_small_job);
    RUN(test_random_jobs);
    RUN(test_layers_of_large_jobs);
    RUN(test_seconds);
    RUN(test_what_is_no_job);
    RUN(test_long_lines);
    RUN(test_seek);
    RUN(test_named_pipe);
    RUN(test_fingerprint);
    RUN(test_no_memory);
    return check_verdict();
}
