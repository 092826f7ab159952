#include "port/choose.h"

#include "base/text.h"

#include <string.h>

/* "usb:… and usb:…"; one that appears twice, by tty and USB, counts once. */
typedef struct crowd {
    const fio_port_entry *first;
    int count;
    char bytes[300];
    fio_text names;
} crowd;

static void join(crowd *these, const fio_port_entry *entry) {
    if (these->count == 0) {
        these->first = entry;
        these->names = fio_text_in(these->bytes, sizeof these->bytes);
    }
    if (these->count++ > 0)
        fio_text_string(&these->names, ", ");
    fio_text_string(&these->names, entry->port.name);
}

/* A USB device we may not open while its tty, which is listed, we may. */
static bool doubled(const fio_port_table *table, const fio_port_entry *entry) {
    if (!entry->usb || entry->port.allowed || !entry->port.tty[0])
        return false;
    for (int i = 0; i < table->count; i++)
        if (!table->entries[i].usb && strcmp(table->entries[i].port.tty, entry->port.tty) == 0)
            return true;
    return false;
}

static crowd gather(const fio_port_table *table, bool certain) {
    crowd these = {0};
    for (int i = 0; i < table->count; i++)
        if ((!certain || table->entries[i].port.certain) && !doubled(table, &table->entries[i]))
            join(&these, &table->entries[i]);
    return these;
}

fio_status fio_port_choose(const fio_port_entry **chosen, const fio_port_table *table) {
    *chosen = NULL;
    crowd certain = gather(table, true), any = gather(table, false);
    const crowd *these = certain.count ? &certain : &any;
    if (these->count == 0)
        return fio_fail(FIO_NO_PRINTER, "no printer found: is it plugged in and switched on? If it "
                                        "is not on USB, name its port with --port");
    if (these->count > 1)
        return fio_fail(
            FIO_NO_PRINTER, "there are %d ports %s: %s; name one with --port", these->count,
            these == &certain ? "with printers" : "that may have a printer", these->bytes);
    *chosen = these->first;
    return FIO_OK;
}

static fio_status none_of_that_name(const fio_port_table *table, const char *name) {
    for (int i = 0; i < table->found_count; i++)
        if (!table->found[i].known && fio_port_names(name, &table->found[i]))
            return fio_fail(FIO_NO_PRINTER, "%s: \"%s\" is no serial port of a kind we know", name,
                            table->found[i].label);
    crowd any = gather(table, false);
    if (any.count == 0)
        return fio_fail(FIO_NO_PRINTER, "%s: not there; is the printer plugged in and on?", name);
    return fio_fail(FIO_NO_PRINTER, "%s: not there; what is: %s", name, any.bytes);
}

fio_status fio_port_choose_usb(const fio_usb_found **chosen, const fio_port_table *table,
                               const char *name) {
    *chosen = NULL;
    crowd these = {0};
    for (int i = 0; i < table->count; i++)
        if (table->entries[i].usb && fio_port_names(name, table->entries[i].usb))
            join(&these, &table->entries[i]);
    if (these.count == 0)
        return none_of_that_name(table, name);
    if (these.count > 1)
        return fio_fail(FIO_NO_PRINTER, "%s: there are %d of them: %s; name one with --port", name,
                        these.count, these.bytes);
    *chosen = these.first->usb;
    return FIO_OK;
}
