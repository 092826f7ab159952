/* What the firmware says. */
#include <string.h>

#include "virtual/machine.h"

#define REPETIER_SEEN 40 /* lines back that Repetier takes for repeats */

void fio_firmware_reply(void *machine, const char *text, size_t length) {
    bool ok = length >= 2 && text[0] == 'o' && text[1] == 'k' && (length == 2 || text[2] == ' ');
    fio_fault_answer(machine, text, length, ok);
}

void fio_firmware_say(fio_machine *machine, const char *text) {
    fio_firmware_reply(machine, text, strlen(text));
}

void fio_firmware_say_lines(fio_machine *machine, const char *lines) {
    while (lines) {
        const char *stop = strchr(lines, '\n');
        fio_firmware_reply(machine, lines, stop ? (size_t)(stop - lines) : strlen(lines));
        lines = stop ? stop + 1 : NULL;
    }
}

static void say_number(fio_machine *machine, const char *before, int64_t number) {
    char bytes[120];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, before);
    fio_text_integer(&text, number);
    fio_firmware_say(machine, bytes);
}

void fio_firmware_ok(fio_machine *machine) {
    char bytes[64];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, "ok");
    machine->counts.oks++;
    if (machine->options.advanced_ok) {
        if (machine->line.has_number) {
            fio_text_string(&text, " N");
            fio_text_integer(&text, machine->line.number);
        }
        fio_text_string(&text, " P");
        fio_text_integer(&text, fio_printer_moves_free(machine->printer));
        fio_text_string(&text, " B");
        fio_text_integer(&text, machine->options.command_slots - machine->queued);
    }
    fio_firmware_say(machine, bytes);
}

void fio_firmware_early_ok(fio_machine *machine, const char *text) {
    machine->counts.oks++;
    if (machine->dialect->numbers_ok && *text == 'N')
        say_number(machine, "ok ", machine->printer->last_number);
    else
        fio_firmware_say(machine, "ok");
}

/* Repetier's complaints are its own. */
static void complain(fio_machine *machine, fio_line_verdict verdict, const char *text) {
    int64_t last = machine->printer->last_number;
    char bytes[120];
    fio_text answer = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&answer, "Error:");
    if (machine->dialect->numbering != FIO_NUMBERS_REPETIER) {
        fio_text_string(&answer, fio_line_complaint(verdict));
        fio_text_string(&answer, ", Last Line: ");
        fio_text_integer(&answer, last);
    } else if (verdict == FIO_LINE_NUMBER) {
        fio_text_string(&answer, "expected line ");
        fio_text_integer(&answer, last + 1);
        fio_text_string(&answer, " got ");
        fio_text_integer(&answer, fio_line_number(text));
    } else
        fio_text_string(&answer,
                        verdict == FIO_LINE_CHECKSUM ? "Wrong checksum" : "Missing checksum");
    fio_firmware_say(machine, bytes);
}

void fio_firmware_reject(fio_machine *machine, fio_line_verdict verdict, const char *text) {
    const fio_dialect *dialect = machine->dialect;
    fio_virtual_printer *printer = machine->printer;
    if (dialect->numbering == FIO_NUMBERS_IGNORED)
        return;
    if (dialect->resend_errors)
        complain(machine, verdict, text);
    printer->statistics.rejected_lines++;
    if (!dialect->resend)
        return;
    if (dialect->resend_ok) { /* Smoothie refuses what follows one by one */
        machine->received_first = machine->received_last;
        machine->lost_before =
            machine->lost_before || machine->mid_line; /* the rest of it is to come */
        machine->mid_line = false;
    }
    say_number(machine, dialect->resend, printer->last_number + 1 + machine->plan.miscount);
    machine->counts.resends++;
    if (!dialect->resend_ok)
        return;
    machine->counts.oks++;
    fio_firmware_say(machine, "ok");
}

/* What an earlier line's number is worth. */
static fio_line_verdict judge_repeat(fio_machine *machine, const char *text) {
    int64_t last = machine->printer->last_number, number = fio_line_number(text);
    switch (machine->dialect->numbering) {
    case FIO_NUMBERS_STRICT:
        return FIO_LINE_NUMBER;
    case FIO_NUMBERS_REPETIER:
        if (number > last || number <= last - REPETIER_SEEN)
            return FIO_LINE_NUMBER;
        say_number(machine, "skip ", number);
        machine->counts.oks++;
        say_number(machine, "ok ", number);
        return FIO_LINE_REPEATED;
    default:
        return number == last || number == last - 1 ? FIO_LINE_REPEATED : FIO_LINE_NUMBER;
    }
}

bool fio_firmware_accepts(fio_machine *machine, const char *text) {
    fio_virtual_printer *printer = machine->printer;
    fio_numbering numbering = machine->dialect->numbering;
    bool bare = *text != 'N';
    if (numbering == FIO_NUMBERS_IGNORED)
        return true;
    int64_t due = numbering == FIO_NUMBERS_SUMS ? fio_line_number(text) - 1 : printer->last_number;
    fio_line_verdict verdict = fio_line_check(text, &due, machine->options.case_insensitive);
    if (verdict == FIO_LINE_REPEATED || verdict == FIO_LINE_NUMBER)
        verdict = judge_repeat(machine, text);
    if (verdict == FIO_LINE_UNCHECKED && numbering == FIO_NUMBERS_SUMS)
        verdict = FIO_LINE_GOOD;
    bool strict = machine->card.saving ? strncmp(text, "M29", 3) != 0 /* a file shall be right */
                                       : machine->plan.demand_checksums;
    if (verdict == FIO_LINE_GOOD && bare && strict)
        verdict = FIO_LINE_UNCHECKED;
    if (verdict == FIO_LINE_GOOD)
        printer->last_number = due;
    else if (verdict == FIO_LINE_REPEATED)
        printer->statistics.duplicate_lines++;
    else
        fio_firmware_reject(machine, verdict, text);
    return verdict == FIO_LINE_GOOD;
}
