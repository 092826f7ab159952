#include "usb/trouble.h"

#include <grp.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

static bool rules_installed(void) {
    static const char *const places[] = {
        "/etc/udev/rules.d/70-isoslice-printers.rules",
        "/usr/lib/udev/rules.d/70-isoslice-printers.rules",
        "/lib/udev/rules.d/70-isoslice-printers.rules",
        "/usr/local/lib/udev/rules.d/70-isoslice-printers.rules",
    };
    for (size_t i = 0; i < sizeof places / sizeof *places; i++)
        if (access(places[i], F_OK) == 0)
            return true;
    return false;
}

void fio_usb_explain_access(char *text, size_t capacity, const fio_usb_found *found) {
    struct stat node;
    const struct group *group = NULL;
    if (stat(found->node, &node) == 0 && node.st_gid != 0 && node.st_mode & S_IWGRP)
        group = getgrgid(node.st_gid);
    if (found->configuration == 0)
        snprintf(text, capacity, "%s is not set up yet; if it stays so, its hub lacks the power",
                 found->node);
    else if (group)
        snprintf(text, capacity,
                 "not allowed to open %s: run \"sudo adduser $USER %s\", log out and in again",
                 found->node, group->gr_name);
    else if (rules_installed())
        snprintf(text, capacity,
                 "not allowed to open %s: unplug the printer and plug it in again, so that the "
                 "udev rules take hold",
                 found->node);
    else
        snprintf(text, capacity,
                 "not allowed to open %s: install isoslice's udev rules "
                 "(70-isoslice-printers.rules into /etc/udev/rules.d), then plug the printer in "
                 "again",
                 found->node);
}

void fio_usb_explain_busy(char *text, size_t capacity, const fio_usb_found *found,
                          const char *holder) {
    if (holder)
        snprintf(text, capacity, "in use by %s; end that first", holder);
    else if (found->kernel[0])
        snprintf(text, capacity,
                 "busy: another program or the kernel's driver %s does not let go of it; end "
                 "OctoPrint, ModemManager and the like",
                 found->kernel);
    else
        snprintf(text, capacity,
                 "busy: another program has it; end OctoPrint, ModemManager and the like");
}
