#include "report.h"

#include <math.h>
#include <string.h>

#include "base/text.h"

static const char *const axes[3] = {"x", "y", "z"};

/* Numbers are written without the locale, so that every machine reads them. */
static void number(FILE *out, const char *before, double value, int decimals, const char *after) {
    char bytes[48];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_number(&text, value, decimals);
    fprintf(out, "%s%s%s", before, bytes, after);
}

static void duration(FILE *out, const char *before, double seconds) {
    long long whole = llround(seconds < 1e15 ? seconds : 1e15);
    fputs(before, out);
    if (whole >= 3600)
        fprintf(out, "%lldh ", whole / 3600);
    if (whole >= 60)
        fprintf(out, "%lldm ", whole / 60 % 60);
    fprintf(out, "%llds", whole % 60);
}

static void box(FILE *out, const fio_statistics *statistics) {
    fprintf(out, "  layers   %lld", (long long)statistics->layers);
    for (int i = 0; i < 3 && statistics->extrusion_moves > 0; i++) {
        fprintf(out, ", %s ", axes[i]);
        number(out, "", statistics->extrusion_minimum[i], 2, " to ");
        number(out, "", statistics->extrusion_maximum[i], 2, "");
    }
    fputs("\n", out);
}

static double printing_time(const fio_statistics *statistics) {
    return statistics->time[FIO_EXTRUDING] + statistics->time[FIO_TRAVELLING] +
           statistics->time[FIO_RETRACTING] + statistics->time[FIO_LIFTING];
}

static void link_summary(FILE *out, const report_subject *subject) {
    const fio_machine_counts *counts = fio_machine_count(subject->machine);
    fprintf(out, "  link     %lld bytes in, %lld out, %lld lines, %lld oks, %lld resends\n",
            (long long)counts->bytes_in, (long long)counts->bytes_out, (long long)counts->lines_in,
            (long long)counts->oks, (long long)counts->resends);
    fprintf(out,
            "  trouble  %lld faults injected, %lld undetectable, %lld bytes overrun, %lld resets, "
            "%lld times starved\n",
            (long long)counts->faults, (long long)counts->undetectable, (long long)counts->overruns,
            (long long)counts->resets, (long long)counts->starved);
    if (subject->bound_first)
        fprintf(out, "  driver   Linux' own has %d of %d interfaces back\n", subject->bound_now,
                subject->bound_first);
    if (subject->check)
        fprintf(out, "  check    %s: %s\n", subject->check,
                subject->check_result ? subject->check_result
                                      : "executed whole, each line once and in order");
}

static void summary(FILE *out, const report_subject *subject) {
    const fio_statistics *statistics = fio_virtual_printer_statistics(subject->printer);
    fprintf(out, "%s on the virtual printer\n", subject->name);
    fprintf(out, "  lines    %lld, %lld commands, %lld moves: %lld extruding, %lld arcs\n",
            (long long)statistics->lines, (long long)statistics->commands,
            (long long)statistics->moves, (long long)statistics->extrusion_moves,
            (long long)statistics->arcs);
    duration(out, "  time     ", printing_time(statistics));
    for (int i = FIO_EXTRUDING; i <= FIO_LIFTING; i++) {
        fprintf(out, "%s%s ", i ? ", " : ": ", fio_activity_name(i));
        number(out, "", statistics->time[i], 1, " s");
    }
    for (int i = FIO_HOMING; i < FIO_ACTIVITIES; i++) {
        fprintf(out, "%s%s ", i > FIO_HOMING ? ", " : "; besides, ", fio_activity_name(i));
        number(out, "", statistics->time[i], 1, " s");
    }
    number(out, "\n  filament ", statistics->filament, 2, " mm, ");
    number(out, "", statistics->volume, 2, " mm3; paths ");
    number(out, "", statistics->extrusion_length / 1000, 3, " m, travel ");
    number(out, "", statistics->travel_length / 1000, 3, " m\n");
    fprintf(out, "  retracted %lld times", (long long)statistics->retractions);
    number(out, ", ", statistics->retracted_length, 2, " mm; back ");
    number(out, "", statistics->unretracted_length, 2, " mm\n");
    box(out, statistics);
    number(out, "  nozzle   ", statistics->highest_nozzle, 0, " C, bed ");
    number(out, "", statistics->highest_bed, 0, " C at most; highest flow ");
    number(out, "", statistics->highest_flow, 2, " mm3/s\n");
    fprintf(out, "  faults   %lld, warnings %lld\n", (long long)statistics->fault_count,
            (long long)statistics->warning_count);
    if (subject->machine)
        link_summary(out, subject);
}

static void event(FILE *out, const char *name, const char *kind, const fio_event *what) {
    if (what->line > 0)
        fprintf(out, "%s:%lld: ", name, (long long)what->line);
    else
        fprintf(out, "%s: at the end: ", name);
    fprintf(out, "%s %s: ", kind, fio_event_name(what->code));
    for (const char *p = what->text; *p; p++) /* the text may quote any bytes of the file */
        fputc((unsigned char)*p < ' ' || (unsigned char)*p > '~' ? '?' : *p, out);
    fputc('\n', out);
}

static void events(FILE *out, const char *name, const fio_virtual_printer *printer) {
    const fio_statistics *statistics = fio_virtual_printer_statistics(printer);
    const fio_event *what;
    for (int64_t i = 0; (what = fio_virtual_printer_fault(printer, i)); i++)
        event(out, name, "fault", what);
    for (int64_t i = 0; (what = fio_virtual_printer_warning(printer, i)); i++)
        event(out, name, "warning", what);
    if (statistics->fault_count > FIO_EVENTS_KEPT)
        fprintf(out, "%s: %lld more faults\n", name,
                (long long)(statistics->fault_count - FIO_EVENTS_KEPT));
    if (statistics->warning_count > FIO_EVENTS_KEPT)
        fprintf(out, "%s: %lld more warnings\n", name,
                (long long)(statistics->warning_count - FIO_EVENTS_KEPT));
}

static void json_string(FILE *out, const char *string) {
    fputc('"', out);
    for (const unsigned char *p = (const unsigned char *)string; *p; p++)
        if (*p == '"' || *p == '\\')
            fprintf(out, "\\%c", *p);
        else if (*p < ' ' || *p > '~') /* bytes of unknown encoding, as Latin-1 */
            fprintf(out, "\\u%04x", *p);
        else
            fputc(*p, out);
    fputc('"', out);
}

static void json_events(FILE *out, const char *name, const fio_virtual_printer *printer,
                        const fio_event *(*get)(const fio_virtual_printer *, int64_t)) {
    fprintf(out, ",\n  \"%s\": [", name);
    const fio_event *what;
    for (int64_t i = 0; (what = get(printer, i)); i++) {
        fprintf(out, "%s\n    {\"code\": \"%s\", \"line\": %lld, \"text\": ", i ? "," : "",
                fio_event_name(what->code), (long long)what->line);
        json_string(out, what->text);
        fputc('}', out);
    }
    fputs("]", out);
}

static void json_integer(FILE *out, const char *name, int64_t value) {
    fprintf(out, ",\n  \"%s\": %lld", name, (long long)value);
}

static void json_number(FILE *out, const char *name, double value) {
    fprintf(out, ",\n  \"%s\": ", name);
    number(out, "", value, 6, "");
}

static void json_box(FILE *out, const char *name, const double corner[3]) {
    fprintf(out, ",\n  \"%s\": ", name);
    for (int i = 0; i < 3; i++)
        number(out, i ? ", " : "[", corner[i], 6, i == 2 ? "]" : "");
}

static void json_link(FILE *out, const report_subject *subject) {
    const fio_machine_counts *counts = fio_machine_count(subject->machine);
    json_integer(out, "bytes_in", counts->bytes_in);
    json_integer(out, "bytes_out", counts->bytes_out);
    json_integer(out, "lines_in", counts->lines_in);
    json_integer(out, "oks", counts->oks);
    json_integer(out, "resends", counts->resends);
    json_integer(out, "faults_injected", counts->faults);
    json_integer(out, "undetectable", counts->undetectable);
    json_integer(out, "overruns", counts->overruns);
    json_integer(out, "resets", counts->resets);
    json_integer(out, "starved", counts->starved);
    if (subject->bound_first) {
        json_integer(out, "driver_interfaces_before", subject->bound_first);
        json_integer(out, "driver_interfaces_after", subject->bound_now);
    }
    if (subject->check)
        fprintf(out, ",\n  \"executed_as_file\": %s", subject->check_result ? "false" : "true");
}

static void json(FILE *out, const report_subject *subject) {
    const fio_virtual_printer *printer = subject->printer;
    const char *name = subject->name;
    const fio_statistics *statistics = fio_virtual_printer_statistics(printer);
    fputs("{\n  \"file\": ", out);
    json_string(out, name);
    json_integer(out, "lines", statistics->lines);
    json_integer(out, "commands", statistics->commands);
    json_integer(out, "unknown_commands", statistics->unknown_commands);
    json_integer(out, "rejected_lines", statistics->rejected_lines);
    json_integer(out, "duplicate_lines", statistics->duplicate_lines);
    json_integer(out, "moves", statistics->moves);
    json_integer(out, "extrusion_moves", statistics->extrusion_moves);
    json_integer(out, "arcs", statistics->arcs);
    json_integer(out, "layers", statistics->layers);
    json_integer(out, "retractions", statistics->retractions);
    json_integer(out, "unretractions", statistics->unretractions);
    json_number(out, "print_time", printing_time(statistics));
    json_number(out, "total_time", statistics->total_time);
    for (int i = 0; i < FIO_ACTIVITIES; i++) {
        char key[32];
        snprintf(key, sizeof key, "time_%s", fio_activity_name(i));
        json_number(out, key, statistics->time[i]);
    }
    json_number(out, "filament_mm", statistics->filament);
    json_number(out, "filament_mm3", statistics->volume);
    json_number(out, "extruded_along_paths_mm", statistics->extruded_along_paths);
    json_number(out, "path_mm", statistics->extrusion_length);
    json_number(out, "travel_mm", statistics->travel_length);
    json_number(out, "retracted_mm", statistics->retracted_length);
    json_number(out, "unretracted_mm", statistics->unretracted_length);
    json_number(out, "still_retracted_mm", statistics->retracted);
    if (statistics->extrusion_moves > 0) {
        json_box(out, "minimum", statistics->extrusion_minimum);
        json_box(out, "maximum", statistics->extrusion_maximum);
    }
    json_number(out, "highest_flow", statistics->highest_flow);
    json_number(out, "highest_nozzle", statistics->highest_nozzle);
    json_number(out, "highest_bed", statistics->highest_bed);
    json_integer(out, "fault_count", statistics->fault_count);
    json_integer(out, "warning_count", statistics->warning_count);
    if (subject->machine)
        json_link(out, subject);
    json_events(out, "faults", printer, fio_virtual_printer_fault);
    json_events(out, "warnings", printer, fio_virtual_printer_warning);
    fputs("\n}\n", out);
}

fio_status report_write(const report_subject *subject, bool as_json) {
    if (as_json)
        json(stdout, subject);
    else if (!subject->quiet)
        summary(stdout, subject);
    if (fflush(stdout) || ferror(stdout))
        return fio_fail(FIO_NOT_WRITTEN, "the summary could not be written");
    if (!as_json)
        events(stderr, subject->name, subject->printer);
    return FIO_OK;
}

void report_log_entry(void *context, const fio_executed *executed) {
    char bytes[320];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    const double numbers[6] = {executed->start,       executed->duration,    executed->position[0],
                               executed->position[1], executed->position[2], executed->position[3]};
    fio_text_integer(&text, executed->line);
    for (int i = 0; i < 6; i++) {
        fio_text_string(&text, "\t");
        fio_text_number(&text, numbers[i], i < 2 ? 6 : 5);
    }
    fio_text_string(&text, "\t");
    fio_text_bytes(&text, executed->text, executed->length);
    fio_text_string(&text, "\n");
    fwrite(bytes, 1, text.length, context);
}
