/* The one list of isoprint-virtual's options, in the order of its help.
 *
 *     VIRTUAL_GROUP(title)
 *     VIRTUAL_OPTION(flag, KIND, member, least, most, value, help)
 *
 * `member` is of virtual_arguments. Kinds: TEXT, NUMBER (double), COUNT (int64_t), SMALL (int),
 * FLAG (sets true), UNFLAG (sets false), AXES and CORNER (three numbers), ID (two hexadecimal
 * numbers), SPEED. `value` is how the help calls it. */

#ifndef VIRTUAL_GROUP
#define VIRTUAL_GROUP(title)
#endif

VIRTUAL_GROUP("What it stands at the far end of")
VIRTUAL_OPTION("--run", TEXT, run, 0, 0, "FILE",
               "a G-code file, '-': standard input; no line at all")
VIRTUAL_OPTION("--pty", LINK, pty, 0, 0, "[LINK]",
               "a pseudo terminal; LINK: a symbolic link to make to it")
VIRTUAL_OPTION("--socket", TEXT, socket, 0, 0, "PATH", "a Unix socket")
VIRTUAL_OPTION("--tcp", TEXT, tcp, 0, 0, "[HOST:]PORT", "a TCP port (localhost; 0: any free one)")
VIRTUAL_OPTION("--usb", TEXT, usb, 0, 0, "CHIP", "a USB device that COMMAND sees (umockdev)")
VIRTUAL_OPTION("--usbip", TEXT, usbip, 0, 0, "CHIP",
               "a USB/IP device: usbip attach -r localhost -b 1-1")
VIRTUAL_OPTION("--usbip-port", TEXT, usbip_port, 0, 0, "[HOST:]PORT", "where it is served (3240)")
VIRTUAL_OPTION("--usbip-attach", TEXT, vhci, 0, 0, "CHIP",
               "a USB device of this machine's own kernel (root, module vhci_hcd)")

VIRTUAL_GROUP("Time and the end")
VIRTUAL_OPTION("--speed", SPEED, speed, 0, 1e6, "S",
               "real, instant (jumps over what it works at), or so many times faster (real)")
VIRTUAL_OPTION("--once", FLAG, once, 0, 0, NULL, "end when the first host has gone")
VIRTUAL_OPTION("--until-idle", NUMBER, idle, 0.001, 1e6, "SECONDS",
               "end when a host has sent nothing for so long")
VIRTUAL_OPTION("--replug", NUMBER, replug, 0, 1e6, "SECONDS",
               "put a pulled plug back after so long (never)")

VIRTUAL_GROUP("What it says")
VIRTUAL_OPTION("--executed", TEXT, executed, 0, 0, "FILE", "write each executed line")
VIRTUAL_OPTION("--log", TEXT, log, 0, 0, "FILE",
               "write each executed line with its time and position")
VIRTUAL_OPTION("--check", TEXT, check, 0, 0, "FILE",
               "executed must be this file: each line once, in order, nothing else")
VIRTUAL_OPTION("--host-commands", TEXT, host_commands, 0, 0, "A,B,...",
               "further commands of the host that --check passes over")
VIRTUAL_OPTION("--json", FLAG, json, 0, 0, NULL, "write the summary as JSON")
VIRTUAL_OPTION("--quiet", FLAG, quiet, 0, 0, NULL, "write no summary, only what is wrong")

VIRTUAL_GROUP("The printer")
VIRTUAL_OPTION("--bed", AXES, machine.printer.size, 0, 1e6, "XxYxZ",
               "size of the volume in mm (250x210x210)")
VIRTUAL_OPTION("--origin", CORNER, machine.printer.origin, -1e6, 1e6, "X,Y,Z",
               "its lowest corner in mm (0,0,0)")
VIRTUAL_OPTION("--filament", NUMBER, machine.printer.filament_diameter, 0, 100, "MM",
               "diameter of the filament (1.75)")
VIRTUAL_OPTION("--max-flow", NUMBER, machine.printer.maximum_flow, 0, 1e9, "MM3",
               "warn above this flow in mm3/s (15)")
VIRTUAL_OPTION("--max-nozzle", NUMBER, machine.printer.nozzle.maximum, 0, 1000, "C",
               "hottest nozzle allowed (285)")
VIRTUAL_OPTION("--classic-jerk", FLAG, machine.printer.classic_jerk, 0, 0, NULL,
               "corners by jerk instead of junction deviation")
VIRTUAL_OPTION("--tools", SMALL, machine.printer.tools, 1, FIO_TOOLS_MOST, "N", "nozzles (1)")
VIRTUAL_OPTION("--planner-blocks", SMALL, machine.printer.planner_blocks, 2, FIO_BLOCKS_MOST, "N",
               "moves that it looks ahead (16)")

VIRTUAL_GROUP("Its firmware (not with --run)")
VIRTUAL_OPTION("--firmware", TEXT, machine.firmware, 0, 0, "NAME",
               "marlin, prusa, klipper, reprapfirmware, smoothie, repetier, grbl (marlin)")
VIRTUAL_OPTION("--rate", COUNT, machine.rate, 0, 100000000, "BITS",
               "of the wire in bits/s; 0: native USB (115200)")
VIRTUAL_OPTION("--receive-bytes", SMALL, machine.receive_bytes, 16, 4096, "N",
               "of its receive buffer (128)")
VIRTUAL_OPTION("--command-slots", SMALL, machine.command_slots, 1, 64, "N",
               "commands that it queues (4)")
VIRTUAL_OPTION("--line-seconds", NUMBER, machine.line_seconds, 0, 1e6, "S",
               "of processor time for each command (0.0003)")
VIRTUAL_OPTION("--busy-seconds", NUMBER, machine.busy_seconds, 0, 1e6, "S",
               "between two 'busy'; 0: says none (2)")
VIRTUAL_OPTION("--boot-seconds", NUMBER, machine.boot_seconds, 0, 1e6, "S",
               "from a reset to 'start' (1)")
VIRTUAL_OPTION("--no-reset", UNFLAG, machine.reset_on_dtr, 0, 0, NULL,
               "does not reset when DTR rises")
VIRTUAL_OPTION("--mute-without-dtr", FLAG, machine.mute_without_dtr, 0, 0, NULL,
               "says nothing until DTR rises")
VIRTUAL_OPTION("--advanced-ok", FLAG, machine.advanced_ok, 0, 0, NULL, "ok N3 P15 B3")
VIRTUAL_OPTION("--no-emergency-parser", UNFLAG, machine.emergency_parser, 0, 0, NULL,
               "M108, M112 and M410 wait for their turn")
VIRTUAL_OPTION("--case-insensitive", FLAG, machine.case_insensitive, 0, 0, NULL, "takes n for N")

VIRTUAL_GROUP("Faults (not with --run); P: a probability for each line, answer or byte, 0 to 1")
VIRTUAL_OPTION("--script", TEXT, script, 0, 0, "FILE", "what goes wrong when, see the manual")
VIRTUAL_OPTION("--do", TEXT, steps, 0, 0, "STEPS",
               "the same in place, as 'at line 100 unplug; at line 300 lose ok 2'")
VIRTUAL_OPTION("--seed", COUNT, seed, 0, INT64_MAX, "N", "of the faults' chance (0)")
VIRTUAL_OPTION("--flip-in", NUMBER, machine.faults.flip_in, 0, 1, "P",
               "one bit of a line on its way to the printer")
VIRTUAL_OPTION("--flip-out", NUMBER, machine.faults.flip_out, 0, 1, "P", "one bit of an answer")
VIRTUAL_OPTION("--flip-bytes", NUMBER, machine.faults.flip_bytes, 0, 1, "P",
               "bits of each byte, both ways")
VIRTUAL_OPTION("--lose-bytes-in", NUMBER, machine.faults.lose_bytes_in, 0, 1, "P",
               "up to 8 bytes of a line are lost")
VIRTUAL_OPTION("--lose-ok", NUMBER, machine.faults.lose_ok, 0, 1, "P", "an ok is lost")
VIRTUAL_OPTION("--double-ok", NUMBER, machine.faults.double_ok, 0, 1, "P", "an ok comes twice")
VIRTUAL_OPTION("--late-ok", NUMBER, machine.faults.late_ok, 0, 1, "P", "an ok comes late")
VIRTUAL_OPTION("--late-seconds", NUMBER, machine.faults.late_seconds, 0, 1e6, "S", "by so long (1)")
VIRTUAL_OPTION("--split", NUMBER, machine.faults.split, 0, 1, "P", "an answer comes in pieces")
VIRTUAL_OPTION("--merge", NUMBER, machine.faults.merge, 0, 1, "P",
               "an answer waits for the next one")

VIRTUAL_GROUP("The USB device")
VIRTUAL_OPTION("--usb-id", ID, usb_device.vendor, 0, 0, "VID:PID", "hexadecimal (the chip's own)")
VIRTUAL_OPTION("--usb-serial", TEXT, usb_device.serial, 0, 0, "TEXT", "serial number (VP0001)")
VIRTUAL_OPTION("--no-union", FLAG, usb_device.no_union, 0, 0, NULL,
               "cdc-acm without a Union descriptor")
VIRTUAL_OPTION("--usb-trace", TEXT, usb_trace, 0, 0, "FILE", "write each control request")
VIRTUAL_OPTION("--usb-stall", COUNT, usb_stall, 0, INT64_MAX, "N",
               "stall the N-th packet from the host, 0 = the first")
VIRTUAL_OPTION("--usb-denied", FLAG, usb_denied, 0, 0, NULL, "COMMAND may not open it (--usb)")
VIRTUAL_OPTION("--usb-bound", FLAG, usb_bound, 0, 0, NULL,
               "Linux' own driver has it at first (--usb)")

#undef VIRTUAL_OPTION
#undef VIRTUAL_GROUP
