/* Doing what the script says. */
#include <math.h>
#include <string.h>

#include "virtual/machine.h"

static double *probability(fio_machine *machine, fio_deed deed) {
    fio_machine_faults *faults = &machine->options.faults;
    double *const places[] = {&faults->flip_in,       &faults->flip_out, &faults->flip_bytes,
                              &faults->lose_bytes_in, &faults->lose_ok,  &faults->double_ok,
                              &faults->late_ok,       &faults->split,    &faults->merge};
    return places[deed - FIO_DO_FLIP_IN];
}

static void change_heater(fio_machine *machine, fio_deed deed) {
    fio_virtual_printer *printer = machine->printer;
    bool bed = deed >= FIO_DO_BED_DEAD;
    fio_heater *heater = bed ? &printer->bed : &printer->nozzle[printer->tool];
    fio_printer_advance(printer, machine->now);
    static const fio_heater_health healths[] = {FIO_HEATER_DEAD, FIO_HEATER_STUCK, FIO_HEATER_WELL,
                                                FIO_THERMISTOR_OPEN, FIO_THERMISTOR_SHORT};
    fio_heater_set(heater, printer->clock, heater->target);
    heater->health = healths[deed - (bed ? FIO_DO_BED_DEAD : FIO_DO_NOZZLE_DEAD)];
    if (printer->waiting && printer->wait_heater == heater)
        printer->wait_end = printer->clock + fio_heater_wait(heater, printer->clock);
}

static void say_two(fio_machine *machine, const char *before, const char *after) {
    char bytes[256];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, before);
    fio_text_string(&text, after);
    fio_firmware_say(machine, bytes);
}

static void ask_for(fio_machine *machine, double number) {
    char bytes[40];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, "Resend: ");
    fio_text_integer(&text, (int64_t)number);
    fio_firmware_say(machine, bytes);
    fio_firmware_say(machine, "ok");
    machine->counts.resends++;
}

static void change_answers(fio_machine *machine, const fio_script_step *step) {
    fio_plan *plan = &machine->plan;
    switch (step->deed) {
    case FIO_DO_LOSE_OK:
        plan->lose_oks += step->value;
        break;
    case FIO_DO_DOUBLE_OK:
        plan->double_oks += step->value;
        break;
    case FIO_DO_LATE_OK:
        plan->late_oks++;
        plan->late_seconds = step->value;
        break;
    case FIO_DO_LOSE_ANSWER:
        plan->lose_answers += step->value;
        break;
    case FIO_DO_FLIP_LINE:
        plan->flip_lines += step->value;
        break;
    case FIO_DO_CUT_LINE:
        plan->cut_lines += step->value;
        break;
    case FIO_DO_REJECT:
        plan->reject_lines += step->value;
        break;
    case FIO_DO_MISCOUNT:
        plan->miscount = (int64_t)step->value;
        break;
    case FIO_DO_OK_FIRST:
    case FIO_DO_OK_LAST:
        plan->ok_first = step->deed == FIO_DO_OK_FIRST;
        break;
    default:
        break;
    }
}

static void perform(fio_machine *machine, const fio_script_step *step) {
    fio_plan *plan = &machine->plan;
    const char *text = step->text < 0 ? "" : machine->script.texts + step->text;
    machine->counts.faults++;
    if (step->deed >= FIO_DO_FLIP_IN) {
        *probability(machine, step->deed) = step->value;
        return;
    }
    if (step->deed >= FIO_DO_NOZZLE_DEAD) {
        change_heater(machine, step->deed);
        return;
    }
    switch (step->deed) {
    case FIO_DO_RESET: /* these two once the processor is between two of its steps */
        plan->reset = true;
        break;
    case FIO_DO_HALT:
        plan->halt = text;
        break;
    case FIO_DO_UNPLUG:
        fio_machine_unplug(machine);
        plan->plug_at = step->value > 0 ? machine->now + step->value : INFINITY;
        break;
    case FIO_DO_PLUG:
        plan->plug_at = machine->now;
        break;
    case FIO_DO_SILENT:
        plan->silent_until = machine->now + step->value;
        break;
    case FIO_DO_MUTE:
        plan->mute_until = machine->now + step->value;
        break;
    case FIO_DO_BUSY:
        plan->busy_until = machine->now + step->value;
        machine->busy_at = machine->now + machine->busy_seconds;
        break;
    case FIO_DO_THROTTLE:
        plan->throttle = step->value;
        break;
    case FIO_DO_ANSWER:
        fio_firmware_say(machine, text);
        break;
    case FIO_DO_ACTION:
        say_two(machine, "//action:", text);
        break;
    case FIO_DO_RESEND:
        ask_for(machine, step->value);
        break;
    case FIO_DO_FORGET:
        machine->printer->last_number = 0;
        break;
    case FIO_DO_DEMAND:
    case FIO_DO_RELAX:
        plan->demand_checksums = step->deed == FIO_DO_DEMAND;
        break;
    case FIO_DO_PRESS:
        fio_firmware_emergency(machine, FIO_EMERGENCY_BREAK);
        break;
    default:
        change_answers(machine, step);
    }
}

void fio_script_happens(fio_machine *machine, fio_moment moment, double count) {
    fio_script *script = &machine->script;
    if (!(script->moments >> moment & 1))
        return;
    for (int i = 0; i < script->count; i++) {
        fio_script_step *step = &script->steps[i];
        bool due = moment == FIO_AT_NUMBER ? count == step->at : count >= step->at;
        if (step->moment != moment || !due)
            continue;
        fio_script_step now = *step;
        step->at = now.every > 0 ? fmax(now.at + now.every, nextafter(count, INFINITY)) : INFINITY;
        if (now.every > 0 && moment != FIO_AT_TIME)
            step->at = now.at + now.every;
        perform(machine, &now);
    }
}

void fio_script_command(fio_machine *machine, const char *text) {
    fio_script *script = &machine->script;
    if (!(script->moments >> FIO_AT_COMMAND & 1))
        return;
    for (int i = 0; i < script->count; i++) {
        fio_script_step *step = &script->steps[i];
        if (step->moment != FIO_AT_COMMAND || step->at == INFINITY)
            continue;
        const char *wanted = script->texts + step->command;
        size_t length = strlen(wanted);
        if (strncmp(text, wanted, length) || (text[length] && text[length] != ' '))
            continue;
        fio_script_step now = *step;
        step->at = now.every > 0 ? 0 : INFINITY;
        perform(machine, &now);
    }
}

double fio_script_next(const fio_machine *machine) {
    const fio_script *script = &machine->script;
    double next = fmin(machine->plan.plug_at, INFINITY);
    if (script->moments >> FIO_AT_TIME & 1)
        for (int i = 0; i < script->count; i++)
            if (script->steps[i].moment == FIO_AT_TIME)
                next = fmin(next, script->steps[i].at);
    return next;
}

void fio_script_pass(fio_machine *machine) {
    fio_plan *plan = &machine->plan;
    fio_script_happens(machine, FIO_AT_TIME, machine->now);
    if (machine->now >= plan->plug_at) {
        plan->plug_at = INFINITY;
        fio_machine_plug_in(machine);
    }
    if (machine->pending && machine->now >= plan->silent_until) {
        fio_emergency what = machine->pending;
        machine->pending = FIO_EMERGENCY_NONE;
        if (machine->processor != FIO_HALTED && machine->processor != FIO_BOOTING)
            fio_firmware_emergency(machine, what);
    }
    const char *halt = plan->halt;
    if (halt && machine->processor != FIO_HALTED && machine->processor != FIO_BOOTING) {
        char bytes[256];
        fio_text text = fio_text_in(bytes, sizeof bytes);
        fio_text_string(&text, "Error:");
        fio_text_string(&text, halt);
        fio_firmware_kill(machine, bytes);
    }
    plan->halt = NULL;
    if (plan->reset)
        fio_firmware_reset(machine);
    plan->reset = false;
}
