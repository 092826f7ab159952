/* Heaters against the exponential they are said to follow. */
#include "rig.h"

static void test_heating_time(void) {
    /* T(t) = full + (T0 - full) exp(-t / tau) reaches the target at tau ln((full-T0)/(full-target))
     */
    fio_virtual_printer *printer = rig_after("M109 S210");
    double nozzle = 120 * log((500. - 20) / (500 - 210));
    CHECK_NEAR(nozzle, rig_state(printer).time, 1e-9);
    CHECK_NEAR(210, rig_state(printer).nozzle[0], 0);
    rig_run(printer, "M190 S60");
    double bed = 300 * log((160. - 20) / (160 - 60));
    CHECK_NEAR(nozzle + bed, rig_state(printer).time, 1e-9);
    CHECK_NEAR(nozzle + bed, rig_statistics(printer)->time[FIO_HEATING], 1e-9);
    CHECK_NEAR(210, rig_state(printer).nozzle[0], 0);     /* held meanwhile */
    rig_run(printer, "M109 S180\nM109 S210\nM190\nM109"); /* S does not wait for cooling */
    CHECK_NEAR(nozzle + bed, rig_state(printer).time, 1e-9);
    fio_virtual_printer_free(printer);
}

static void test_heating_on_the_way(void) {
    fio_virtual_printer *printer = rig_after("M104 S210\nG4 S30");
    double expected = 500 + (20 - 500.) * exp(-30. / 120);
    CHECK_NEAR(expected, rig_state(printer).nozzle[0], 1e-9);
    rig_run(printer, "G4 S20");
    CHECK_NEAR(500 + (20 - 500.) * exp(-50. / 120), rig_state(printer).nozzle[0], 1e-9);
    rig_run(printer, "M104 S0\nG4 S60"); /* cools from where it was */
    double peak = 500 + (20 - 500.) * exp(-50. / 120);
    CHECK_NEAR(20 + (peak - 20) * exp(-0.5), rig_state(printer).nozzle[0], 1e-9);
    CHECK_NEAR(peak, rig_statistics(printer)->highest_nozzle, 1e-9);
    rig_run(printer, "M104 S200\nG4 S1000");
    CHECK_NEAR(200, rig_state(printer).nozzle[0], 0);
    fio_virtual_printer_free(printer);
}

static void test_waiting_for_cooling(void) {
    fio_virtual_printer *printer = rig_after("M109 S210");
    double before = rig_state(printer).time;
    rig_run(printer, "M109 R100");
    /* There within one degree. */
    CHECK_NEAR(120 * log((210. - 20) / (101 - 20)), rig_state(printer).time - before, 1e-9);
    CHECK_NEAR(101, rig_state(printer).nozzle[0], 1e-9);
    before = rig_state(printer).time;
    rig_run(printer, "M190 R10"); /* colder than the room: never */
    CHECK_NEAR(before, rig_state(printer).time, 0);
    CHECK_EQUAL(1, rig_statistics(printer)->count[FIO_FAULT_TEMPERATURE]);
    fio_virtual_printer_free(printer);
}

static void test_heating_while_moving(void) {
    /* The bed warms while the head travels: the wait is only for the rest. */
    fio_virtual_printer *printer = rig_after("G28\nM140 S60\nG1 X200 F600\nM190 S60");
    double whole = 300 * log((160. - 20) / (160 - 60));
    double moving = rig_statistics(printer)->time[FIO_TRAVELLING];
    CHECK(moving > 20);
    CHECK_NEAR(whole - moving, rig_statistics(printer)->time[FIO_HEATING], 1e-9);
    fio_virtual_printer_free(printer);
}

int main(void) {
    RUN(test_heating_time);
    RUN(test_heating_on_the_way);
    RUN(test_waiting_for_cooling);
    RUN(test_heating_while_moving);
    return check_verdict();
}
