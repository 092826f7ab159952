/* What a job has set, as far as it is followed, against the virtual printer's own reading of the
 * same commands; and that the commands of fio_track_restore() bring another printer there. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <isoprint/virtual_printer.h>

#include "check.h"
#include "protocol/track.h"

static uint64_t random_state = 99;

static unsigned random_below(unsigned bound) {
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return (unsigned)(random_state % bound);
}

static double random_to(double limit) {
    return (double)random_below((unsigned)(limit * 1000)) / 1000;
}

static fio_virtual_printer *new_printer(void) {
    fio_virtual_options options = fio_virtual_options_defaults();
    fio_virtual_printer *printer = NULL;
    options.tools = 3;
    options.extrusion_maximum_length = 1e6;
    if (fio_virtual_printer_create(&printer, &options, NULL) != FIO_OK)
        exit(1);
    return printer;
}

typedef struct rig {
    fio_virtual_printer *printer;
    fio_track track;
    fio_state state;
} rig;

static void execute(fio_virtual_printer *printer, const char *text) {
    CHECK_EQUAL(FIO_OK, fio_virtual_printer_run(printer, text, strlen(text)));
}

static void give(rig *r, const char *command) {
    execute(r->printer, command);
    fio_track_follow(&r->track, command, strlen(command));
    fio_virtual_printer_state(r->printer, &r->state);
}

static rig new_rig(void) {
    rig r = {.printer = new_printer()};
    fio_track_reset(&r.track);
    return r;
}

/* What the state says that the track says too. */
static bool agrees(const fio_track *track, const fio_state *state) {
    bool same = true;
    for (int i = 0; i < 4; i++)
        same = CHECK_NEAR(state->position[i], track->position[i], 1e-6) && same;
    same = CHECK_EQUAL(state->inches, track->inches) && same;
    same = CHECK_EQUAL(!state->absolute, track->relative) && same;
    same = CHECK_EQUAL(!state->absolute_extrusion, track->relative_extrusion) && same;
    same = CHECK_NEAR(state->feedrate * 60, track->feedrate, 1e-6) && same;
    same = CHECK_NEAR(state->fan, track->fan, 0) && same;
    same = CHECK_EQUAL(state->tool, track->tool) && same;
    same = CHECK_NEAR(state->bed_target, fmax(track->bed, 0), 0) && same;
    for (int i = 0; i < 3; i++)
        same = CHECK_NEAR(state->nozzle_target[i], fmax(track->nozzle[i], 0), 0) && same;
    same = CHECK_NEAR(state->feedrate_percent, track->feedrate_percent, 0) && same;
    same = CHECK_NEAR(state->flow_percent, track->flow_percent, 0) && same;
    for (int i = 0; i < 3; i++)
        if (track->acceleration[i] > 0)
            same = CHECK_NEAR(state->acceleration[i], track->acceleration[i], 1e-9) && same;
    return CHECK_EQUAL(state->homed[0] && state->homed[1] && state->homed[2], track->homed) && same;
}

/* A move that stays within the volume, whatever the units and modes. */
static void random_move(const rig *r, char *text) {
    static const double size[3] = {250, 210, 100};
    const fio_state *s = &r->state;
    double unit = s->inches ? 25.4 : 1;
    char *p = text + sprintf(text, "G%u", random_below(2));
    for (int i = 0; i < 3; i++) {
        if (random_below(2))
            continue;
        double to = random_to(size[i]), from = s->machine[i];
        double offset = s->position[i] - from;
        p += sprintf(p, " %c%.4f", 'X' + i, (s->absolute ? to + offset : to - from) / unit);
    }
    if (random_below(2))
        p += sprintf(p, " E%.5f",
                     (s->absolute_extrusion ? s->position[3] + random_to(2) : random_to(2)) / unit);
    if (random_below(3) == 0)
        sprintf(p, " F%.1f", (600 + random_to(6000)) / unit);
}

static void random_command(const rig *r, char *text) {
    static const char *const others[] = {"G28",        "G28 X",       "G28 Y Z",
                                         "G28 O",      "G20",         "G21",
                                         "G90",        "G91",         "M82",
                                         "M83",        "M107",        "M106",
                                         "M106 P1",    "G92 E0",      "G92 X10 Y20",
                                         "G92 Z1.5",   "G92.1",       "T0",
                                         "T1",         "T2",          "M104 T1 S180",
                                         "M109 R20",   "M104 S0",     "M140 S0",
                                         "M190 R20",   "M204 S1000",  "M204 P500 T900",
                                         "M204 R800 ", "M220 S80",    "M221 S95.5",
                                         "M220 S0",    "M105",        "M117 G1 X5",
                                         "M84 S100",   "G4 P10",      "M400",
                                         "g1 f1200",   "m106 s12.5 ", "G1 E1 E2",
                                         "G92",        "M104",        "M73 P3 R5",
                                         "; G28",      "G10",         "G11",
                                         "M84 E",      "M18 X",       "G1 X Y5 Y"};
    switch (random_below(5)) {
    case 0:
    case 1:
    case 2:
        random_move(r, text);
        break;
    case 3:
        strcpy(text, others[random_below(sizeof others / sizeof *others)]);
        break;
    default:
        sprintf(text, random_below(2) ? "M106 S%u" : "M104 S%u", random_below(256));
    }
}

static rig random_job(int length) {
    rig r = new_rig();
    char text[200];
    give(&r, "M104 S210");
    give(&r, "M140 S60");
    give(&r, "G28");
    give(&r, "G1 F3000");
    for (int i = 0; i < length; i++) {
        random_command(&r, text);
        bool named = strchr(text, ';') == NULL;
        if (named)
            give(&r, text);
    }
    return r;
}

static void test_follows_what_the_printer_does(void) {
    for (int round = 0; round < 300; round++) {
        rig r = random_job((int)random_below(60));
        bool same = agrees(&r.track, &r.state);
        fio_virtual_printer_free(r.printer);
        if (!same) {
            fprintf(stderr, "    round %d\n", round);
            break;
        }
    }
}

static bool is_at(const fio_track *track, const fio_state *state, bool moved) {
    bool same = true;
    for (int i = 0; i < 3 && moved; i++)
        same = CHECK_NEAR(track->position[i], state->position[i], 1e-4) && same;
    fio_track compared = *track;
    memcpy(compared.position, state->position, sizeof compared.position);
    compared.position[3] = track->position[3];
    fio_state rounded = *state; /* restored texts have 5 decimals of E, 3 of F */
    if (fabs(state->position[3] - track->position[3]) < 1e-5)
        rounded.position[3] = track->position[3];
    if (fabs(state->feedrate * 60 - track->feedrate) < 1e-3)
        rounded.feedrate = track->feedrate / 60;
    for (int i = 0; i < 3; i++)
        rounded.homed[i] = track->homed; /* z is never homed */
    for (int i = 0; i < 3; i++)
        if (fabs(rounded.acceleration[i] - compared.acceleration[i]) < 5e-3)
            rounded.acceleration[i] = compared.acceleration[i];
    return agrees(&compared, &rounded) && same;
}

/* A printer that was reset: nothing of it is left but where the axes stand. */
static void test_restores_after_a_reset(void) {
    char text[FIO_TRACK_TEXT];
    for (int round = 0; round < 300; round++) {
        rig r = random_job((int)random_below(60));
        fio_virtual_printer *again = new_printer();
        size_t length = fio_track_restore(&r.track, true, 2, 1.5, text);
        CHECK_EQUAL(strlen(text), length);
        execute(again, text);
        fio_state state;
        fio_virtual_printer_state(again, &state);
        bool same = is_at(&r.track, &state, r.track.homed);
        /* The volume's origin is where it was: G92 had moved only the names of places. */
        for (int i = 0; i < 2 && r.track.homed; i++)
            same = CHECK_NEAR(r.state.machine[i], state.machine[i], 2e-4) && same;
        CHECK(strstr(text, "G28 Z") == NULL && strstr(text, "G28\n") == NULL);
        CHECK_EQUAL(0, fio_virtual_printer_statistics(again)->count[FIO_FAULT_COLD_EXTRUSION]);
        fio_virtual_printer_free(r.printer);
        fio_virtual_printer_free(again);
        if (!same) {
            fprintf(stderr, "    round %d:\n%s", round, text);
            break;
        }
    }
}

/* A pause: lifted, parked, cooled, in other modes, but not reset. */
static void test_restores_after_a_pause(void) {
    char text[FIO_TRACK_TEXT];
    for (int round = 0; round < 300; round++) {
        rig r = random_job((int)random_below(60));
        fio_state before = r.state, after;
        execute(r.printer, "M204 P1000 R1000 T1000\nM83\nG1 E-1 F1800\nG21\nG91\nG1 Z2 F600\nG90\n"
                           "M104 S0\nM106 S0\nM220 S50\n");
        fio_track_follow(&r.track, "M204 P1000 R1000 T1000", 22);
        fio_track_restore(&r.track, false, 2, 1, text);
        execute(r.printer, text);
        fio_virtual_printer_state(r.printer, &after);
        bool same = is_at(&r.track, &after, r.track.homed);
        for (int i = 0; i < 3 && r.track.homed; i++)
            same = CHECK_NEAR(before.machine[i], after.machine[i], 2e-4) && same;
        CHECK(strstr(text, "G28") == NULL);
        fio_virtual_printer_free(r.printer);
        if (!same) {
            fprintf(stderr, "    round %d:\n%s", round, text);
            break;
        }
    }
}

static void follow(fio_track *track, const char *text) {
    fio_track_reset(track);
    for (const char *end; *text; text = *end ? end + 1 : end) {
        end = text + strcspn(text, "\n");
        fio_track_follow(track, text, (size_t)(end - text));
    }
}

static void test_order_of_what_is_restored(void) {
    fio_track track;
    char text[FIO_TRACK_TEXT];
    follow(&track, "M140 S60\nM104 S200\nG28\nM83\nG1 X50 Y60 Z1.2 F3000\nG1 X70 E2 F1200\n"
                   "M106 S127.5\nM220 S90\nG91");
    track.raised = 0.5;
    fio_track_restore(&track, true, 2, 1, text);
    static const char expected[] = "M140 S60.0\nM104 S200.0\nM190 S60.0\nM109 S200.0\nG21\nG90\n"
                                   "G92 Z1.7000\nG1 Z3.7000 F600\nG28 X Y\n"
                                   "G1 X70.0000 Y60.0000 F6000\nG1 Z1.2000 F600\n"
                                   "M83\nG1 E1.0000 F1800\nG92 E2.00000\n"
                                   "M220 S90.00\nM221 S100.00\nG1 F1200.000\nM106 S127.50\n"
                                   "G91\nM83\n";
    if (!CHECK(strcmp(expected, text) == 0))
        fprintf(stderr, "%s", text);
}

/* Before the job has homed, nothing may move; cold, nothing is primed. */
static void test_nothing_moves_too_early(void) {
    fio_track track;
    char text[FIO_TRACK_TEXT];
    static const char *const jobs[] = {"", "M104 S200\nG1 X5 Y5 Z5", "M104 S200\nG28\nM84",
                                       "M104 S200\nG28 X Y"};
    for (size_t i = 0; i < sizeof jobs / sizeof *jobs; i++) {
        follow(&track, jobs[i]);
        fio_track_restore(&track, true, 2, 1, text);
        CHECK(!strstr(text, "G28") && !strstr(text, "Z") && !strstr(text, "G1 X"));
        CHECK(!strstr(text, "G1 E"));
    }
    follow(&track, "G28\nG1 X5 Y5 Z5 E3\nM104 S0");
    fio_track_restore(&track, false, 2, 1, text);
    CHECK(strstr(text, "G1 X5") && !strstr(text, "G1 E") && !strstr(text, "M109"));
    CHECK(strstr(text, "M104 S0.0\n"));
}

/* The longest there is fits. */
static void test_longest_text(void) {
    fio_track track;
    char text[FIO_TRACK_TEXT];
    follow(&track, "G28\nG20\nG91\nM83");
    for (int i = 0; i < FIO_TRACK_TOOLS; i++)
        track.nozzle[i] = 1e9;
    for (int i = 0; i < 4; i++)
        track.position[i] = -123456789.123456;
    for (int i = 0; i < 3; i++)
        track.offset[i] = track.acceleration[i] = 123456789.123456;
    track.bed = track.feedrate = track.fan = track.feedrate_percent = track.flow_percent = 1e8;
    track.tool = 7;
    size_t length = fio_track_restore(&track, true, 1e8, 1e8, text);
    CHECK(length < FIO_TRACK_TEXT - 1 && strcmp(text + length - 5, "\nG20\n") == 0);
}

/* Words that would not be taken by the firmware either. */
static void test_damaged_commands(void) {
    fio_track track, before;
    follow(&track, "G28\nG1 X5 Y6 Z7 E8 F900\nM104 S200");
    before = track;
    static const char *const bad[] = {
        "",
        " ",
        "G",
        "M",
        "T",
        "X5",
        "G1",
        "G1 X",
        "G1 X9999999999",
        "G1 F0",
        "G1 F-3",
        "G1.5 X3",
        "G5 X3",
        "M104",
        "M104 S",
        "M104 T9 S5",
        "M104 T-1 S5",
        "T99",
        "T",
        "M220 S-1",
        "M221",
        "G92",
        "G92 X",
        "M106 P2 S3",
        "G10 P1 X3",
        "G99999999999 X3",
        "\xff\xfe",
        "N5 G1 X3",
        "M140",
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        fio_track_follow(&track, bad[i], strlen(bad[i]));
        if (!CHECK(memcmp(&track, &before, sizeof track) == 0)) {
            fprintf(stderr, "    %s\n", bad[i]);
            track = before;
        }
    }
}

int main(void) {
    RUN(test_follows_what_the_printer_does);
    RUN(test_restores_after_a_reset);
    RUN(test_restores_after_a_pause);
    RUN(test_order_of_what_is_restored);
    RUN(test_nothing_moves_too_early);
    RUN(test_longest_text);
    RUN(test_damaged_commands);
    return check_verdict();
}
