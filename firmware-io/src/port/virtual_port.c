#include "port/virtual_port.h"

#include <isoprint/machine.h>

#include "base/memory.h"
#include "base/number.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

enum { SCRIPT_MOST = 1 << 20 };

/* The machine belongs to the port, while its own transport leaves it to its caller. */
typedef struct virtual_port {
    fio_transport transport; /* comes first */
    fio_transport *inner;
    fio_machine *machine;
    char firmware[32];
} virtual_port;

static fio_transport *inner(const fio_transport *transport) {
    return ((const virtual_port *)transport)->inner;
}

static fio_status virtual_read(fio_transport *transport, void *bytes, size_t capacity,
                               size_t *count) {
    return fio_transport_read(inner(transport), bytes, capacity, count);
}

static fio_status virtual_write(fio_transport *transport, const void *bytes, size_t size,
                                size_t *taken) {
    return fio_transport_write(inner(transport), bytes, size, taken);
}

static size_t virtual_pending(const fio_transport *transport) {
    return fio_transport_pending(inner(transport));
}

static fio_status virtual_discard(fio_transport *transport, size_t *kept) {
    return fio_transport_discard(inner(transport), kept);
}

static fio_status virtual_wait(fio_transport *transport, bool writing, struct pollfd *others,
                               int count, double seconds) {
    return fio_transport_wait(inner(transport), writing, others, count, seconds);
}

static double virtual_now(const fio_transport *transport) {
    return fio_transport_now(inner(transport));
}

static fio_status virtual_set_rate(fio_transport *transport, int64_t rate) {
    const fio_transport_type *type = inner(transport)->type;
    return type->set_rate ? type->set_rate(inner(transport), rate) : FIO_OK;
}

static fio_status virtual_set_lines(fio_transport *transport, bool dtr, bool rts) {
    const fio_transport_type *type = inner(transport)->type;
    return type->set_lines ? type->set_lines(inner(transport), dtr, rts) : FIO_OK;
}

static void virtual_close(fio_transport *transport) {
    virtual_port *self = (virtual_port *)transport;
    fio_transport_close(self->inner);
    fio_machine_free(self->machine);
    fio_release(self);
}

static const fio_transport_type virtual_type = {
    .name = "virtual",
    .read = virtual_read,
    .write = virtual_write,
    .pending = virtual_pending,
    .discard = virtual_discard,
    .wait = virtual_wait,
    .now = virtual_now,
    .set_rate = virtual_set_rate,
    .set_lines = virtual_set_lines,
    .close = virtual_close,
};

/* --- options -----------------------------------------------------------------------------------*/

typedef struct setting {
    const char *name;
    double *number;
    bool *truth;
    int *integer;
} setting;

static bool set_one(fio_machine_options *machine, double *speed, const char *name, size_t length,
                    double value) {
    double rate = (double)machine->rate, seed = (double)machine->seed;
    fio_machine_faults *faults = &machine->faults;
    const setting settings[] = {
        {"speed", speed, NULL, NULL},
        {"rate", &rate, NULL, NULL},
        {"seed", &seed, NULL, NULL},
        {"receive_bytes", NULL, NULL, &machine->receive_bytes},
        {"command_slots", NULL, NULL, &machine->command_slots},
        {"line_seconds", &machine->line_seconds, NULL, NULL},
        {"busy_seconds", &machine->busy_seconds, NULL, NULL},
        {"boot_seconds", &machine->boot_seconds, NULL, NULL},
        {"reset_on_dtr", NULL, &machine->reset_on_dtr, NULL},
        {"mute_without_dtr", NULL, &machine->mute_without_dtr, NULL},
        {"advanced_ok", NULL, &machine->advanced_ok, NULL},
        {"emergency_parser", NULL, &machine->emergency_parser, NULL},
        {"case_insensitive", NULL, &machine->case_insensitive, NULL},
        {"flip_in", &faults->flip_in, NULL, NULL},
        {"flip_out", &faults->flip_out, NULL, NULL},
        {"flip_bytes", &faults->flip_bytes, NULL, NULL},
        {"lose_bytes_in", &faults->lose_bytes_in, NULL, NULL},
        {"lose_ok", &faults->lose_ok, NULL, NULL},
        {"double_ok", &faults->double_ok, NULL, NULL},
        {"late_ok", &faults->late_ok, NULL, NULL},
        {"late_seconds", &faults->late_seconds, NULL, NULL},
        {"split", &faults->split, NULL, NULL},
        {"merge", &faults->merge, NULL, NULL},
    };
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        const setting *one = &settings[i];
        if (strlen(one->name) != length || memcmp(one->name, name, length) != 0)
            continue;
        if (one->number)
            *one->number = value;
        else if (one->truth)
            *one->truth = value != 0;
        else if (value >= 0 && value <= 1e6)
            *one->integer = (int)value;
        else
            return false;
        if (!(rate >= 0 && rate <= 1e9 && seed >= 0 && seed <= 1e9 && *speed >= 0 && *speed <= 1e6))
            return false;
        machine->rate = (int64_t)rate;
        machine->seed = (uint64_t)seed;
        return true;
    }
    return false;
}

/* "NAME=NUMBER NAME=NUMBER …", parted by blanks or commas; also "firmware=NAME", which is copied
 * into `firmware`. */
static fio_status read_options(fio_machine_options *machine, double *speed, char firmware[32],
                               const char *text) {
    for (const char *at = text; *(at += strspn(at, " ,"));) {
        size_t length = strcspn(at, " ,"), name = strcspn(at, "= ,");
        const char *end = at + length, *value = at + name + 1;
        double number;
        bool known = name < length && value < end;
        if (known && name == 8 && memcmp(at, "firmware", 8) == 0) {
            known = snprintf(firmware, 32, "%.*s", (int)(end - value), value) < 32;
            machine->firmware = firmware;
        } else {
            known = known && fio_number_read(&number, value, end) == end &&
                    set_one(machine, speed, at, name, number);
        }
        if (!known)
            return fio_fail(FIO_USAGE,
                            "\"%.*s\" is no option of the virtual printer, or a value it can't "
                            "have",
                            (int)length, at);
        at = end;
    }
    return FIO_OK;
}

/* A whole file as text; *text is the caller's. */
static fio_status read_script(char **text, const char *path) {
    *text = NULL;
    FILE *file = fopen(path, "re");
    if (!file)
        return fio_fail(FIO_UNREADABLE, "%s: %s", path, strerror(errno));
    char *bytes = fio_allocate(SCRIPT_MOST + 1);
    size_t size = bytes ? fread(bytes, 1, SCRIPT_MOST + 1, file) : 0;
    bool broken = ferror(file);
    fclose(file);
    fio_status status = FIO_OK;
    if (!bytes)
        status = fio_fail(FIO_NO_MEMORY, "no memory for a script");
    else if (broken)
        status = fio_fail(FIO_UNREADABLE, "%s: can't be read", path);
    else if (size > SCRIPT_MOST || memchr(bytes, 0, size))
        status = fio_fail(FIO_UNREADABLE, "%s: no script: too long, or not text", path);
    if (status != FIO_OK) {
        fio_release(bytes);
        return status;
    }
    *text = bytes;
    return FIO_OK;
}

static fio_status create(virtual_port *self, const char *script, const fio_port_options *options) {
    fio_machine_options machine = fio_machine_options_defaults();
    char *text = NULL;
    double speed = 1;
    machine.rate = options->rate;
    fio_status status = read_options(&machine, &speed, self->firmware,
                                     options->virtual_options ? options->virtual_options : "");
    if (status == FIO_OK && script)
        status = read_script(&text, script);
    machine.script = text;
    if (status == FIO_OK)
        status = fio_machine_create(&self->machine, &machine);
    if (status == FIO_OK)
        status = fio_machine_transport(&self->inner, self->machine, 0, speed);
    if (status == FIO_OK)
        status = virtual_set_rate(&self->transport, options->rate);
    if (status == FIO_OK && !options->keep_lines)
        status = virtual_set_lines(&self->transport, true, true);
    fio_release(text);
    return status;
}

fio_status fio_virtual_port_open(fio_transport **transport, const char *script,
                                 const fio_port_options *options) {
    *transport = NULL;
    virtual_port *self = fio_allocate(sizeof *self);
    if (!self)
        return fio_fail(FIO_NO_MEMORY, "no memory for a port");
    self->transport.type = &virtual_type;
    fio_status status = create(self, script, options);
    if (status != FIO_OK) {
        virtual_close(&self->transport);
        return status;
    }
    *transport = &self->transport;
    return FIO_OK;
}
