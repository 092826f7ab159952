/* What was executed equals the file: every command once, in order, with times without gaps. */
#include "rig.h"

enum { MOST = 4000 };

typedef struct record {
    int count;
    int64_t line[MOST];
    double start[MOST], duration[MOST], x[MOST], e[MOST];
    char text[MOST * 40];
    size_t used;
} record;

static record made;

static void keep(void *context, const fio_executed *executed) {
    record *r = context;
    int i = r->count++;
    CHECK(i < MOST && strlen(executed->text) == executed->length);
    r->line[i] = executed->line;
    r->start[i] = executed->start;
    r->duration[i] = executed->duration;
    r->x[i] = executed->position[0];
    r->e[i] = executed->position[3];
    r->used +=
        (size_t)snprintf(r->text + r->used, sizeof r->text - r->used, "%s\n", executed->text);
}

static const fio_execution_log *fresh_log(void) {
    static fio_execution_log log = {keep, &made};
    memset(&made, 0, sizeof made);
    return &log;
}

static void expect_no_gaps(double end) {
    double clock = 0;
    for (int i = 0; i < made.count; i++) {
        CHECK_NEAR(clock, made.start[i], 1e-9);
        CHECK(made.duration[i] >= 0 && made.start[i] == made.start[i]);
        clock = made.start[i] + made.duration[i];
    }
    CHECK_NEAR(end, clock, 1e-9);
}

/* A print of many moves, arcs, settings between moves, and long runs of commands that don't move.
 */
static char *sample(size_t *length) {
    static char text[MOST * 40];
    size_t used =
        (size_t)snprintf(text, sizeof text, "M104 S200\nG28\nM109 S200\nM83\nG1 Z0.2 F600\n");
    for (int i = 0; i < 600; i++) {
        used += (size_t)snprintf(text + used, sizeof text - used, "G1 X%d Y%d E0.05 F%d\n",
                                 20 + i * 7 % 50, 20 + i * 11 % 60, 600 + i % 40 * 60);
        if (i % 10 == 0)
            used += (size_t)snprintf(text + used, sizeof text - used, "M106 S%d\n", i % 256);
        if (i % 50 == 0)
            used += (size_t)snprintf(text + used, sizeof text - used, "G2 I10 J3 E0.4\n");
        for (int k = 0; i % 150 == 0 && k < 400; k++)
            used += (size_t)snprintf(text + used, sizeof text - used, "M117 message %d\n", k);
    }
    *length = used;
    return text;
}

static void test_executed_equals_the_file(void) {
    size_t length;
    const char *text = sample(&length);
    fio_virtual_printer *printer = rig_make(NULL, fresh_log());
    rig_run(printer, text);
    CHECK_EQUAL(FIO_FAULTY, fio_virtual_printer_finish(printer)); /* the nozzle is left on */
    CHECK_EQUAL(1, rig_statistics(printer)->fault_count);
    CHECK_EQUAL(rig_statistics(printer)->commands, made.count);
    CHECK(!strcmp(text, made.text));
    for (int i = 0; i < made.count; i++)
        CHECK_EQUAL(i + 1, made.line[i]);
    expect_no_gaps(rig_state(printer).time);
    double with_log = rig_state(printer).time;
    fio_virtual_printer_free(printer);

    printer = rig_after(text); /* a log changes no time */
    CHECK_EQUAL(FIO_FAULTY, fio_virtual_printer_finish(printer));
    CHECK(with_log == rig_state(printer).time);
    fio_virtual_printer_free(printer);
}

static void test_entries(void) {
    fio_virtual_printer *printer = rig_make(NULL, fresh_log());
    rig_run(printer, "; nothing\nG28 ; home\n\n  g1 x100 (here) F6000\nM117 a ; b\nG4 S2\n");
    CHECK_EQUAL(FIO_OK, fio_virtual_printer_finish(printer));
    CHECK(!strcmp("G28\ng1 x100  F6000\nM117 a\nG4 S2\n", made.text));
    static const int64_t lines[4] = {2, 4, 5, 6};
    for (int i = 0; i < 4; i++)
        CHECK_EQUAL(lines[i], made.line[i]);
    CHECK_NEAR(125 / 50. + 105 / 50. + 105 / 8., made.duration[0], 1e-9);
    CHECK_NEAR(1 + 100. / 1500, made.duration[1], 1e-9);
    CHECK_NEAR(2, made.duration[3], 1e-9);
    CHECK_NEAR(0, made.x[0], 0);
    CHECK_NEAR(100, made.x[1], 0);
    expect_no_gaps(rig_state(printer).time);
    fio_virtual_printer_free(printer);
}

static void test_rejected_lines_are_not_in_it(void) {
    fio_virtual_printer *printer = rig_make(NULL, fresh_log());
    rig_run(printer, "G28\nN1 G1 X5*0");
    rig_run(printer, rig_numbered(1, "G1 X5"));
    rig_run(printer, rig_numbered(1, "G1 X5"));
    rig_run(printer, "G1 X50 F600\n");
    CHECK_EQUAL(FIO_OK, fio_virtual_printer_finish(printer));
    CHECK(!strcmp("G28\nG1 X5\nG1 X50 F600\n", made.text));
    CHECK_EQUAL(3, made.line[1]);
    fio_virtual_printer_free(printer);
}

static void test_moves_lost_by_an_emergency_stop(void) {
    fio_virtual_printer *printer = rig_make(NULL, fresh_log());
    rig_run(printer, "G28\nG1 X100 F600\nM117 on\nG1 X50\nM112\nG1 X7\n");
    CHECK_EQUAL(FIO_FAULTY, fio_virtual_printer_finish(printer));
    CHECK(!strcmp("G28\nM117 on\nM112\n", made.text));
    expect_no_gaps(rig_state(printer).time);
    fio_virtual_printer_free(printer);
}

int main(void) {
    RUN(test_executed_equals_the_file);
    RUN(test_entries);
    RUN(test_rejected_lines_are_not_in_it);
    RUN(test_moves_lost_by_an_emergency_stop);
    return check_verdict();
}
