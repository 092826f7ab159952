/* Who gets the interfaces of a device, against what Linux 6.1's cdc-acm was seen to do. */
#include "standin/usb_claim.h"

#include <errno.h>

#include "check.h"

/* Two interfaces, communications and data; and one of a vendor's own. */
static const uint8_t acm[] = {9, 4, 0, 0, 1, 2, 2, 1, 0, 9, 4, 1, 0, 2, 10, 0, 0, 0};
static const uint8_t bridge[] = {9, 4, 0, 0, 2, 255, 0, 0, 0};
static int us, others;

static fio_usb_claims with(const uint8_t *descriptors, size_t size) {
    fio_usb_claims claims;
    fio_usb_claims_begin(&claims, descriptors, size, true);
    return claims;
}

static int bound(const fio_usb_claims *claims) {
    int now, first;
    fio_usb_claims_count(claims, &now, &first);
    return now;
}

static void test_what_a_driver_has_is_not_to_be_claimed(void) {
    fio_usb_claims claims = with(bridge, sizeof bridge);
    CHECK_EQUAL(EBUSY, fio_usb_claims_claim(&claims, 0, &us));
    CHECK_EQUAL(0, fio_usb_claims_unbind(&claims, 0));
    CHECK_EQUAL(ENODATA, fio_usb_claims_unbind(&claims, 0));
    CHECK_EQUAL(0, fio_usb_claims_claim(&claims, 0, &us));
    CHECK_EQUAL(0, fio_usb_claims_claim(&claims, 0, &us));
    CHECK_EQUAL(EBUSY, fio_usb_claims_claim(&claims, 0, &others));
    CHECK(!strcmp(fio_usb_claims_driver(&claims, 0), "usbfs"));
    CHECK_EQUAL(EINVAL, fio_usb_claims_release(&claims, 0, &others));
    CHECK_EQUAL(EBUSY, fio_usb_claims_bind(&claims, 0));
    CHECK_EQUAL(0, fio_usb_claims_release(&claims, 0, &us));
    CHECK_EQUAL(0, fio_usb_claims_bind(&claims, 0));
    CHECK_EQUAL(1, bound(&claims));
    CHECK_EQUAL(ENOENT, fio_usb_claims_claim(&claims, 7, &us));
}

static fio_usb_claims both_ours(void) {
    fio_usb_claims claims = with(acm, sizeof acm);
    CHECK(!strcmp(fio_usb_claims_driver(&claims, 1), "cdc_acm"));
    CHECK_EQUAL(0, fio_usb_claims_unbind(&claims, 0));
    CHECK_EQUAL(0, bound(&claims)); /* it lets go of both at once */
    CHECK_EQUAL(0, fio_usb_claims_claim(&claims, 0, &us));
    CHECK_EQUAL(0, fio_usb_claims_claim(&claims, 1, &us));
    return claims;
}

static void give_back(fio_usb_claims *claims, unsigned interface) {
    CHECK_EQUAL(0, fio_usb_claims_release(claims, interface, &us));
    CHECK_EQUAL(0, fio_usb_claims_bind(claims, interface));
}

static void test_cdc_acm_comes_back_if_the_data_interface_is_released_first(void) {
    fio_usb_claims claims = both_ours();
    give_back(&claims, 1);
    CHECK_EQUAL(0, bound(&claims));
    give_back(&claims, 0);
    CHECK_EQUAL(2, bound(&claims));
}

static void test_cdc_acm_is_lost_if_the_control_interface_is_released_first(void) {
    fio_usb_claims claims = both_ours();
    give_back(&claims, 0);
    give_back(&claims, 1);
    CHECK_EQUAL(0, bound(&claims));
}

static void test_a_killed_program_gives_nothing_back_to_the_driver(void) {
    fio_usb_claims claims = both_ours();
    fio_usb_claims_vanish(&claims, &us);
    CHECK_EQUAL(0, bound(&claims));
    CHECK(!fio_usb_claims_driver(&claims, 0) && !fio_usb_claims_driver(&claims, 1));
    CHECK_EQUAL(0, fio_usb_claims_claim(&claims, 1, &others));
}

int main(void) {
    RUN(test_what_a_driver_has_is_not_to_be_claimed);
    RUN(test_cdc_acm_comes_back_if_the_data_interface_is_released_first);
    RUN(test_cdc_acm_is_lost_if_the_control_interface_is_released_first);
    RUN(test_a_killed_program_gives_nothing_back_to_the_driver);
    return check_verdict();
}
