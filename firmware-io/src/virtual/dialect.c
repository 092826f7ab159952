/* From the firmwares' own sources and logs: Prusa-Firmware 3.14 (a Marlin 1.0), Repetier 1.0,
 * Klipper's gcode.py, Grbl 1.1h, Smoothieware's GcodeDispatch, RepRapFirmware 3. */
#include "virtual/dialect.h"

#include <stddef.h>
#include <string.h>

static const fio_dialect dialects[] = {
    {.name = "marlin",
     .banner = "start\nMarlin 2.1 (isoprint virtual printer)",
     .identity = "FIRMWARE_NAME:Marlin 2.1 (isoprint virtual printer) PROTOCOL_VERSION:1.0 "
                 "MACHINE_TYPE:Virtual EXTRUDER_COUNT:",
     .resend = "Resend: ",
     .resend_errors = true,
     .resend_ok = true,
     .busy = "echo:busy: ",
     .out_of_band = true,
     .capabilities = true,
     .unknown = "echo:Unknown command: ",
     .killed = "Error:Printer halted. kill() called!\n//action:poweroff"},
    {.name = "prusa",
     .banner = "start\necho: 3.14.1-8237\necho: Last Updated: virtual",
     .identity = "FIRMWARE_NAME:Prusa-Firmware 3.14.1 (isoprint virtual printer) based on Marlin "
                 "PROTOCOL_VERSION:1.0 MACHINE_TYPE:Prusa i3 MK3S EXTRUDER_COUNT:",
     .numbering = FIO_NUMBERS_STRICT,
     .resend = "Resend: ",
     .resend_errors = true,
     .resend_ok = true,
     .busy = "echo:busy: ",
     .capabilities = true,
     .unknown = "echo:Unknown command: ",
     .killed = "Error:Printer halted. kill() called!"},
    {.name = "repetier",
     .banner = "start\nInfo:External Reset",
     .identity = "FIRMWARE_NAME:Repetier_1.0.4 (isoprint virtual printer) PROTOCOL_VERSION:1.0 "
                 "MACHINE_TYPE:Virtual EXTRUDER_COUNT:",
     .numbering = FIO_NUMBERS_REPETIER,
     .resend = "Resend:",
     .resend_errors = true,
     .resend_ok = true,
     .numbers_ok = true,
     .early_ok = true,
     .busy = "busy:",
     .wait_seconds = 1,
     .unknown = "Unknown command:",
     .killed = "fatal:Emergency stop",
     .dead = "fatal:Emergency stop"},
    {.name = "klipper",
     .banner = NULL,
     .identity = "FIRMWARE_NAME:Klipper FIRMWARE_VERSION:v0.12.0-virtual",
     .numbering = FIO_NUMBERS_IGNORED,
     .out_of_band = true,
     .ok_last = true,
     .unknown = "// Unknown command:",
     .killed = "// Klipper state: Shutdown",
     .dead = "// Shutdown due to M112 command\n"
             "// Once the underlying issue is corrected, use the\n"
             "// \"FIRMWARE_RESTART\" command to reset the firmware, reload the\n"
             "// config, and restart the host software.\n"
             "// Printer is shutdown\n"
             "!! Shutdown due to M112 command\n"
             "ok"},
    {.name = "grbl",
     .banner = "\nGrbl 1.1h ['$' for help]",
     .numbering = FIO_NUMBERS_IGNORED,
     .killed = "ALARM:1\n[MSG:Reset to continue]",
     .dead = "error:9"},
    {.name = "smoothie",
     .banner = "Smoothie\nok",
     .identity = "FIRMWARE_NAME:Smoothieware, FIRMWARE_VERSION:virtual, PROTOCOL_VERSION:1.0, "
                 "X-AXES:4",
     .numbering = FIO_NUMBERS_STRICT,
     .resend = "rs N",
     .out_of_band = true,
     .unknown = "// Unknown command:",
     .killed = "ok Emergency Stop Requested - reset or M999 required to exit HALT state",
     .dead = "!!"},
    {.name = "reprapfirmware",
     .banner = NULL,
     .identity = "FIRMWARE_NAME: RepRapFirmware for Duet 2 WiFi/Ethernet FIRMWARE_VERSION: 3.4.6 "
                 "ELECTRONICS: isoprint virtual printer",
     .numbering = FIO_NUMBERS_SUMS,
     .out_of_band = true,
     .unknown = "Error: Bad command: ",
     .killed = "Emergency Stop! Reset the controller to continue.",
     .dead = NULL},
};

const fio_dialect *fio_dialect_find(const char *name) {
    for (size_t i = 0; name && i < sizeof dialects / sizeof *dialects; i++)
        if (!strcmp(dialects[i].name, name))
            return &dialects[i];
    return NULL;
}
