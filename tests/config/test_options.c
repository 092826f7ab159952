/* The table of options: defaults, ranges, texts, round trips, derived values. */
#include <isoslice/config.h>

#include <locale.h>
#include <stdint.h>
#include <stdlib.h>

#include "check.h"
#include "config/spelling.h"
#include "config/settings.h"
#include "config/value.h"

static iso_options options, other;
static char text[ISO_VALUE_TEXT_SIZE];

static uint32_t random_state = 12345;

static uint32_t random_below(uint32_t n) {
    random_state = random_state * 1664525u + 1013904223u;
    return (random_state >> 8) % n;
}

/* ---- single values ---- */

static double number_of(const char *string) {
    double number = -77;
    const char *at = string;
    return iso_number_read(&number, &at) && *at == 0 ? number : NAN;
}

static void test_numbers_are_read_as_the_c_library_does(void) {
    static const char *const good[] = {
        "0",       "0.2",   "-0.25",    "+3",         "1e-3",
        "12.5e+2", ".5",    "5.",       "999999.999", "0.000000001",
        "1000000", "0.1e1", "00012.50", "-1e6",       "123456.123456789"};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++)
        CHECK(number_of(good[i]) == strtod(good[i], NULL));
}

static void test_what_is_no_number_is_refused(void) {
    static const char *const bad[] = {"",
                                      "-",
                                      ".",
                                      "e3",
                                      "nan",
                                      "inf",
                                      "0x10",
                                      "1,5",
                                      "1e7",
                                      "1000001",
                                      "99999999999999999999999",
                                      "1e400",
                                      "1 2"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        CHECK(isnan(number_of(bad[i])));
}

static void test_long_fractions_are_rounded(void) {
    CHECK(number_of("0.12345678949") == 0.123456789);
    CHECK(number_of("0.1234567895") == 0.12345679);
    CHECK(number_of("1e-300") == 0);
    CHECK(number_of("0.3333333333333333333333333333333333333333") == 0.333333333);
}

static void test_written_numbers_are_read_back_exactly(void) {
    for (int i = 0; i < 100000; i++) {
        int64_t nano = (int64_t)random_below(1u << 24) * (int64_t)random_below(59604644u);
        double number = (double)nano / 1e9 * (random_below(2) ? 1 : -1);
        char digits[32];
        CHECK(iso_number_write(digits, number) < 32);
        if (!CHECK(number_of(digits) == number) || !CHECK(strtod(digits, NULL) == number))
            return;
    }
}

/* ---- the table ---- */

static void test_every_default_is_in_range_and_in_its_shortest_form(void) {
    iso_options_defaults(&options);
    for (int32_t i = 0; i < iso_option_count(); i++) {
        const iso_option_info *info = iso_option_at(i);
        CHECK_OK(iso_options_set(&other, info->key, info->initial, "default"));
        iso_options_format(text, sizeof text, &options, i);
        if (!CHECK(strcmp(text, info->initial) == 0))
            fprintf(stderr, "  %s: %s is written as %s\n", info->key, info->initial, text);
        CHECK(iso_options_is_default(&options, i));
        CHECK(info->help[strlen(info->help) - 1] == '.');
    }
    CHECK_OK(iso_options_check(&options));
}

static void test_keys_are_found_with_either_dash_and_only_once(void) {
    for (int32_t i = 0; i < iso_option_count(); i++) {
        char key[64];
        snprintf(key, sizeof key, "%s", iso_option_at(i)->key);
        CHECK_EQUAL(i, iso_option_find(key));
        for (char *c = key; *c; c++)
            *c = *c == '_' ? '-' : *c;
        CHECK_EQUAL(i, iso_option_find(key));
    }
    CHECK_EQUAL(-1, iso_option_find("layer_heigh"));
    CHECK_EQUAL(-1, iso_option_find("layer_height2"));
    CHECK_EQUAL(-1, iso_option_find(""));
}

static void test_numbers_out_of_range_are_refused_and_change_nothing(void) {
    iso_options_defaults(&options);
    other = options;
    for (int32_t i = 0; i < iso_option_count(); i++) {
        const iso_option_info *info = iso_option_at(i);
        if (info->kind == ISO_VALUE_BOOL || info->kind == ISO_VALUE_TEXT || iso_option_word(i, 0))
            continue;
        bool whole = info->kind == ISO_VALUE_INTEGER;
        for (int high = 0; high < 2; high++) {
            char number[32], value[160];
            double step = whole ? 1 : 0.001;
            iso_number_write(number, high ? info->max + step : info->min - step);
            snprintf(value, sizeof value,
                     info->kind == ISO_VALUE_POINTS  ? "0x0,100x0,100x%s"
                     : info->kind == ISO_VALUE_PLACE ? "1,%s"
                                                     : "%s",
                     number);
            CHECK_STATUS(ISO_BAD_CONFIG, iso_options_set(&options, info->key, value, "a.ini:7"));
            CHECK(strncmp(iso_error_message(), "a.ini:7: ", 9) == 0);
            CHECK(strstr(iso_error_message(), info->key) != NULL);
        }
    }
    CHECK(memcmp(&options, &other, sizeof options) == 0);
}

static void test_the_ends_of_every_range_can_be_said(void) {
    iso_options_defaults(&other);
    for (int32_t i = 0; i < iso_option_count(); i++) {
        const iso_option_info *info = iso_option_at(i);
        if ((info->kind != ISO_VALUE_INTEGER && info->kind != ISO_VALUE_NUMBER) ||
            iso_option_word(i, 0))
            continue;
        char number[32];
        iso_number_write(number, info->min);
        CHECK_OK(iso_options_set(&other, info->key, number, "lowest"));
        iso_number_write(number, info->max);
        CHECK_OK(iso_options_set(&other, info->key, number, "highest"));
    }
}

static void test_messages_say_where_what_and_what_is_allowed(void) {
    CHECK_STATUS(ISO_BAD_CONFIG, iso_options_set(&options, "layer_height", "7", "--layer-height"));
    CHECK(strcmp(iso_error_message(),
                 "--layer-height: layer_height = 7 is out of range; allowed: 0.01 to 5 mm") == 0);
    CHECK_STATUS(ISO_BAD_CONFIG, iso_options_set(&options, "seam_position", "front", "-s"));
    CHECK(
        strcmp(iso_error_message(),
               "-s: seam_position = front is not known; allowed: random, nearest, aligned, rear") ==
        0);
    CHECK_STATUS(ISO_BAD_CONFIG, iso_options_set(&options, "layer-hieght", "1", "-s"));
    CHECK(strstr(iso_error_message(), "is it layer_height?") != NULL);
}

static void test_wrong_values_are_refused(void) {
    static const char *const wrong[][2] = {{"perimeters", "2.5"},
                                           {"perimeters", "two"},
                                           {"cooling", "2"},
                                           {"cooling", ""},
                                           {"layer_height", ""},
                                           {"layer_height", "0.2mm"},
                                           {"layer_height", "20%"},
                                           {"fill_density", "20%%"},
                                           {"extrusion_width", "-5%"},
                                           {"extrusion_width", "1001%"},
                                           {"first_layer_height", "0%"},
                                           {"bed_shape", ""},
                                           {"bed_shape", "0x0,1x1"},
                                           {"bed_shape", "0x0,1x1,2"},
                                           {"bed_shape", "0,0,1,1,2,2"},
                                           {"bed_shape", "0x0,9x0,9x9,"},
                                           {"center", "100"},
                                           {"center", "1,2,3"},
                                           {"layer_heights", "0.2,,0.2"},
                                           {"layer_heights", "0.2;0.3"},
                                           {"layer_heights", "0.2,"},
                                           {"start_gcode", "a\001b"}};
    iso_options_defaults(&options);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        CHECK_STATUS(ISO_BAD_CONFIG, iso_options_set(&options, wrong[i][0], wrong[i][1], "test"));
}

static void test_values_have_prusaslicers_forms(void) {
    iso_options_defaults(&options);
    CHECK_OK(iso_options_set(&options, "fill_density", "15", "test"));
    CHECK_NEAR(15, options.fill_density, 0);
    CHECK_OK(iso_options_set(&options, "fill_density", "37.5%", "test"));
    CHECK_NEAR(37.5, options.fill_density, 0);
    CHECK_OK(iso_options_set(&options, "extrusion_width", "105%", "test"));
    CHECK(options.extrusion_width.percent);
    CHECK_NEAR(105, options.extrusion_width.value, 0);
    CHECK_OK(iso_options_set(&options, "bed_shape", "0x0,400x0,400x400,0x400", "test"));
    CHECK_EQUAL(4, options.bed_shape.count);
    CHECK_NEAR(400, options.bed_shape.point[2].y, 0);
    CHECK_OK(iso_options_set(&options, "center", "200,150", "test"));
    CHECK_NEAR(150, iso_options_center(&options).y, 0);
    CHECK_OK(iso_options_set(&options, "gcode_flavor", "marlin", "test"));
    CHECK_EQUAL(ISO_FLAVOUR_MARLIN, options.gcode_flavor);
    CHECK_OK(iso_options_set(&options, "start_gcode", " G28\\nM83 ; \\\\ slash\\r\\n ", "test"));
    CHECK(strcmp(options.start_gcode, "G28\nM83 ; \\ slash\n") == 0);
    CHECK_OK(iso_options_set(&options, "layer_heights", "0.3, 0.2,1e-1", "test"));
    CHECK_EQUAL(3, options.layer_heights.count);
    CHECK_NEAR(0.1, options.layer_heights.value[2], 0);
}

static void test_lists_and_texts_of_full_length_fit_and_longer_ones_do_not(void) {
    static char list[200000];
    iso_options_defaults(&options);
    memset(list, 'n', ISO_TEXT_SIZE);
    list[ISO_TEXT_SIZE - 1] = 0;
    CHECK_OK(iso_options_set(&options, "end_gcode", list, "test"));
    list[ISO_TEXT_SIZE - 1] = 'n';
    list[ISO_TEXT_SIZE] = 0;
    CHECK_STATUS(ISO_BAD_CONFIG, iso_options_set(&options, "end_gcode", list, "test"));
    size_t length = 0;
    for (int i = 0; i < ISO_NUMBERS_MAX; i++)
        length += (size_t)sprintf(list + length, "%s0.123456789", i ? "," : "");
    CHECK_OK(iso_options_set(&options, "layer_heights", list, "test"));
    CHECK_EQUAL(length,
                iso_options_format(text, sizeof text, &options, iso_option_find("layer_heights")));
    CHECK(strcmp(text, list) == 0);
    strcat(list, ",0.2");
    CHECK_STATUS(ISO_BAD_CONFIG, iso_options_set(&options, "layer_heights", list, "test"));
    length = 0;
    for (int i = 0; i < ISO_POINTS_MAX; i++)
        length += (size_t)sprintf(list + length, "%s%dx%d", i ? "," : "", i, i * i % 100);
    CHECK_OK(iso_options_set(&options, "bed_shape", list, "test"));
    strcat(list, ",1x1");
    CHECK_STATUS(ISO_BAD_CONFIG, iso_options_set(&options, "bed_shape", list, "test"));
}

static void test_a_text_that_does_not_fit_is_cut_off_and_its_length_told(void) {
    char small[8];
    iso_options_defaults(&options);
    int32_t bed = iso_option_find("bed_shape");
    CHECK_EQUAL(strlen(iso_option_at(bed)->initial),
                iso_options_format(small, sizeof small, &options, bed));
    CHECK(strcmp(small, "0x0,200") == 0);
    CHECK_EQUAL(23, iso_options_format(NULL, 0, &options, bed));
}

/* ---- round trip: print(set(random)) is what is set again ---- */

static void random_number(char *out, const iso_option_info *info) {
    double low = info->min, high = info->max;
    double number = low + (high - low) * random_below(1u << 20) / (double)((1u << 20) - 1);
    if (info->kind == ISO_VALUE_INTEGER)
        number = (double)(int64_t)number;
    iso_number_write(out, number);
}

static void random_value(char *out, int32_t option) {
    const iso_option_info *info = iso_option_at(option);
    char x[32], y[32];
    int count = (int)random_below(6);
    *out = 0;
    if (iso_option_word(option, 0)) {
        strcpy(out, iso_option_word(option, (int32_t)random_below(2)));
    } else if (info->kind == ISO_VALUE_BOOL) {
        strcpy(out, random_below(2) ? "1" : "0");
    } else if (info->kind == ISO_VALUE_TEXT) {
        for (int i = 0; i < 40; i++)
            out[i] = " \\nG1;=[]#\"xX.-"[random_below(15)];
        out[40] = 0;
    } else if (info->kind == ISO_VALUE_POINTS) {
        for (int i = 0; i < 3 + count; i++) {
            random_number(x, info);
            random_number(y, info);
            sprintf(out + strlen(out), "%s%sx%s", i ? "," : "", x, y);
        }
    } else if (info->kind == ISO_VALUE_PLACE) {
        random_number(x, info);
        random_number(y, info);
        sprintf(out, "%s,%s", x, y);
    } else if (info->kind == ISO_VALUE_NUMBERS) {
        for (int i = 0; i < count; i++) {
            random_number(x, info);
            sprintf(out + strlen(out), "%s%s", i ? "," : "", x);
        }
    } else {
        random_number(out, info);
        if (info->kind == ISO_VALUE_RELATIVE && random_below(2))
            sprintf(out, "%u.%u%%", 1 + random_below(999), random_below(1000000));
    }
}

static iso_status set_other(void *payload, const char *key, const char *value) {
    ++*(int *)payload;
    return iso_options_set(&other, key, value, "round trip");
}

static void test_printed_options_are_read_back_to_the_same_bytes(void) {
    for (int turn = 0; turn < 300; turn++) {
        iso_options_defaults(&options);
        iso_options_defaults(&other);
        for (int32_t i = 0; i < iso_option_count(); i++) {
            random_value(text, i);
            CHECK_OK(iso_options_set(&options, iso_option_at(i)->key, text, "random"));
        }
        int printed = 0;
        CHECK_OK(iso_options_print(&options, set_other, &printed));
        CHECK_EQUAL(iso_option_count(), printed);
        for (int32_t i = 0; i < iso_option_count(); i++) {
            static char again[ISO_VALUE_TEXT_SIZE];
            iso_options_format(text, sizeof text, &options, i);
            iso_options_format(again, sizeof again, &other, i);
            CHECK(strcmp(text, again) == 0);
        }
        CHECK(options.layer_height == other.layer_height);
        CHECK(memcmp(&options.bed_shape.count, &other.bed_shape.count, sizeof(int32_t)) == 0);
        CHECK(strcmp(options.start_gcode, other.start_gcode) == 0);
    }
}

static void test_only_changed_options_are_printed(void) {
    int printed = 0;
    iso_options_defaults(&options);
    iso_options_defaults(&other);
    CHECK_OK(iso_options_print_changed(&options, set_other, &printed));
    CHECK_EQUAL(0, printed);
    options.perimeters = 5;
    options.center = (iso_place){true, 10, 20};
    CHECK_OK(iso_options_print_changed(&options, set_other, &printed));
    CHECK_EQUAL(2, printed);
    CHECK_EQUAL(5, other.perimeters);
    CHECK_NEAR(20, other.center.y, 0);
}

/* ---- what follows from several ---- */

static void test_widths_follow_prusaslicers_rules(void) {
    iso_options_defaults(&options);
    CHECK_NEAR(0.45, iso_options_width(&options, ISO_ROLE_PERIMETER, false, 0.3), 1e-12);
    CHECK_NEAR(0.4, iso_options_width(&options, ISO_ROLE_TOP_SOLID_INFILL, false, 0.3), 1e-12);
    CHECK_NEAR(0.7, iso_options_width(&options, ISO_ROLE_PERIMETER, true, 0.35), 1e-12);
    CHECK_OK(iso_options_set(&options, "extrusion_width", "0.5", "test"));
    CHECK_NEAR(0.5, iso_options_width(&options, ISO_ROLE_TOP_SOLID_INFILL, false, 0.3), 1e-12);
    CHECK_OK(iso_options_set(&options, "infill_extrusion_width", "230%", "test"));
    CHECK_NEAR(0.46, iso_options_width(&options, ISO_ROLE_INTERNAL_INFILL, false, 0.2), 1e-12);
    CHECK_NEAR(0.5, iso_options_width(&options, ISO_ROLE_SOLID_INFILL, false, 0.2), 1e-12);
    CHECK_OK(iso_options_set(&options, "first_layer_extrusion_width", "0", "test"));
    CHECK_NEAR(0.46, iso_options_width(&options, ISO_ROLE_INTERNAL_INFILL, true, 0.2), 1e-12);
}

static void test_speeds_follow_prusaslicers_rules(void) {
    iso_options_defaults(&options);
    CHECK_NEAR(60, iso_options_speed(&options, ISO_ROLE_PERIMETER, false, false), 1e-12);
    CHECK_NEAR(30, iso_options_speed(&options, ISO_ROLE_EXTERNAL_PERIMETER, false, false), 1e-12);
    CHECK_NEAR(15, iso_options_speed(&options, ISO_ROLE_EXTERNAL_PERIMETER, true, false), 1e-12);
    CHECK_NEAR(80, iso_options_speed(&options, ISO_ROLE_INTERNAL_INFILL, true, false), 1e-12);
    CHECK_NEAR(30, iso_options_speed(&options, ISO_ROLE_INTERNAL_INFILL, false, true), 1e-12);
    CHECK_OK(iso_options_set(&options, "solid_infill_speed", "50%", "test"));
    CHECK_OK(iso_options_set(&options, "top_solid_infill_speed", "25%", "test"));
    CHECK_NEAR(10, iso_options_speed(&options, ISO_ROLE_TOP_SOLID_INFILL, false, false), 1e-12);
    CHECK_OK(iso_options_set(&options, "first_layer_speed", "40%", "test"));
    CHECK_NEAR(32, iso_options_speed(&options, ISO_ROLE_INTERNAL_INFILL, false, true), 1e-12);
}

static void test_percent_of_the_first_layer_is_of_each_speed(void) {
    iso_options_defaults(&options);
    CHECK_OK(iso_options_set(&options, "first_layer_speed", "40%", "test"));
    iso_gcode_options gcode = settings_of_gcode(&options, NULL, 0);
    CHECK_NEAR(12, gcode.first_layer_speed[ISO_ROLE_EXTERNAL_PERIMETER], 1e-12);
    CHECK_NEAR(24, gcode.first_layer_speed[ISO_ROLE_PERIMETER], 1e-12);
    CHECK_NEAR(32, gcode.first_layer_speed[ISO_ROLE_INTERNAL_INFILL], 1e-12);
    CHECK_NEAR(6, gcode.first_layer_small_perimeter_speed, 1e-12);
    CHECK_OK(iso_options_set(&options, "first_layer_speed", "25", "test"));
    gcode = settings_of_gcode(&options, NULL, 0);
    CHECK_NEAR(25, gcode.first_layer_speed[ISO_ROLE_INTERNAL_INFILL], 1e-12);
    CHECK_NEAR(25, gcode.first_layer_small_perimeter_speed, 1e-12);
}

static void test_heights_centre_and_overlap(void) {
    static double height[ISO_NUMBERS_MAX + 1];
    iso_options_defaults(&options);
    CHECK_EQUAL(2, iso_options_heights(height, &options));
    CHECK_NEAR(0.35, height[0], 0);
    CHECK_NEAR(0.3, height[1], 0);
    CHECK_NEAR(0.1125, iso_options_infill_overlap(&options, false, 0.3), 1e-12);
    CHECK_NEAR(100, iso_options_center(&options).x, 0);
    CHECK_OK(iso_options_set(&options, "first_layer_height", "50%", "test"));
    CHECK_NEAR(0.15, iso_options_first_height(&options), 1e-12);
    CHECK_OK(iso_options_set(&options, "layer_heights", "0.2,0.1", "test"));
    CHECK_EQUAL(3, iso_options_heights(height, &options));
    CHECK_NEAR(0.2, height[0], 0);
    CHECK_NEAR(0.3, height[2], 0);
    CHECK_OK(iso_options_set(&options, "bed_shape", "-50x-20,70x-20,70x60,-50x60", "test"));
    CHECK_NEAR(10, iso_options_center(&options).x, 1e-12);
    CHECK_NEAR(20, iso_options_center(&options).y, 1e-12);
}

static void test_options_that_do_not_go_together_are_refused(void) {
    static const char *const wrong[][2] = {
        {"layer_height", "0.5"},           {"first_layer_height", "0.41"},
        {"layer_heights", "0.3,0.3,0.5"},  {"perimeter_extrusion_width", "0.2"},
        {"infill_extrusion_width", "99%"}, {"min_fan_speed", "101"},
        {"bed_shape", "0x0,10x10,20x20"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        iso_options_defaults(&options);
        if (iso_options_set(&options, wrong[i][0], wrong[i][1], "test") == ISO_OK)
            CHECK_STATUS(ISO_BAD_CONFIG, iso_options_check(&options));
    }
    iso_options_defaults(&options);
    options.max_fan_speed = 20;
    CHECK_STATUS(ISO_BAD_CONFIG, iso_options_check(&options));
    CHECK(strcmp(iso_error_message(), "min_fan_speed = 35 is above max_fan_speed = 20") == 0);
}

static void test_placeholders_are_filled_in(void) {
    char out[256];
    iso_options_defaults(&options);
    options.bed_temperature = 60;
    CHECK_OK(iso_options_expand(out, sizeof out,
                                "M140 S[bed_temperature]\nM104 S{temperature}\n"
                                "M109 S{first_layer_temperature[0]} ; [fill_density]",
                                &options));
    CHECK(strcmp(out, "M140 S60\nM104 S200\nM109 S200 ; 20%") == 0);
    CHECK_OK(iso_options_expand(out, sizeof out, "", &options));
    CHECK(strcmp(out, "") == 0);
    static const char *const wrong[] = {"[nothing]", "{if temperature > 3}", "[temperature ",
                                        "M104 S{temperature}{", "[]"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        CHECK_STATUS(ISO_BAD_CONFIG, iso_options_expand(out, sizeof out, wrong[i], &options));
    CHECK_STATUS(ISO_BAD_CONFIG, iso_options_expand(out, 9, "M104 S[temperature]", &options));
    CHECK_OK(iso_options_expand(out, 8, "M104 S[perimeters]", &options));
}

static void test_placeholders_of_a_layer(void) {
    char out[64];
    iso_options_defaults(&options);
    CHECK_OK(iso_options_set(&options, "z_offset", "0.5", "test"));
    CHECK_OK(
        iso_options_set(&options, "layer_gcode", ";L [layer_num] {layer_z} [temperature]", ""));
    iso_texts texts = {0};
    texts_begin(&texts, &options, NULL);
    iso_gcode_options gcode = settings_of_gcode(&options, &texts, 0);
    const iso_gcode_place place = {.layer = 7, .z = 0.35, .max_z = 0.35};
    CHECK_OK(gcode.text(out, sizeof out, gcode.text_payload, ISO_TEXT_BEFORE_LAYER, &place));
    CHECK(strcmp(out, "") == 0);
    CHECK_OK(gcode.text(out, sizeof out, gcode.text_payload, ISO_TEXT_LAYER, &place));
    CHECK(strcmp(out, ";L 7 0.35 200") == 0); /* as PrusaSlicer 2.5 has it: without the offset */
    CHECK_STATUS(ISO_BAD_CONFIG, gcode.text(out, 9, gcode.text_payload, ISO_TEXT_LAYER, &place));
    CHECK_OK(iso_options_set(&options, "layer_gcode", "[layer_number]", ""));
    CHECK_STATUS(ISO_BAD_CONFIG,
                 gcode.text(out, sizeof out, gcode.text_payload, ISO_TEXT_LAYER, &place));
    CHECK_STATUS(ISO_BAD_CONFIG, iso_options_expand(out, sizeof out, "[layer_num]", &options));
    texts_free(&texts);
}

static void test_misspelt_words_are_near_and_others_are_not(void) {
    CHECK_EQUAL(0, iso_edit_distance("layer_height", "layer-height"));
    CHECK_EQUAL(2, iso_edit_distance("layer_height", "layer_hieght"));
    CHECK_EQUAL(1, iso_edit_distance("skirts", "skirt"));
    CHECK_EQUAL(3, iso_edit_distance("kitten", "sitting"));
    CHECK_EQUAL(6, iso_edit_distance("", "skirts"));
    CHECK(strcmp(iso_option_suggest("perimeter"), "perimeters") == 0);
    CHECK(iso_option_suggest("wipe_tower_rotation") == NULL);
    CHECK(iso_option_suggest("x") == NULL);
}

static void test_density_of_a_lattice_in_any_locale(void) {
    static const struct {
        double percent;
        const char *text;
    } row[] = {{20, "20"}, {12.5, "12.5"}, {33.333333333, "33.333333333"}, {0, "0"}, {100, "100"}};
    for (int german = 0; german < 2; german++) {
        if (german)
            setlocale(LC_NUMERIC, "de_DE.UTF-8"); /* where there is one */
        for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
            char percent[32];
            iso_options_defaults(&options);
            options.fill_density = row[i].percent;
            CHECK(strcmp(row[i].text, settings_of_lattice(&options, percent).density) == 0);
        }
    }
    setlocale(LC_NUMERIC, "C");
}

int main(void) {
    RUN(test_numbers_are_read_as_the_c_library_does);
    RUN(test_what_is_no_number_is_refused);
    RUN(test_long_fractions_are_rounded);
    RUN(test_written_numbers_are_read_back_exactly);
    RUN(test_every_default_is_in_range_and_in_its_shortest_form);
    RUN(test_keys_are_found_with_either_dash_and_only_once);
    RUN(test_numbers_out_of_range_are_refused_and_change_nothing);
    RUN(test_the_ends_of_every_range_can_be_said);
    RUN(test_messages_say_where_what_and_what_is_allowed);
    RUN(test_wrong_values_are_refused);
    RUN(test_values_have_prusaslicers_forms);
    RUN(test_lists_and_texts_of_full_length_fit_and_longer_ones_do_not);
    RUN(test_a_text_that_does_not_fit_is_cut_off_and_its_length_told);
    RUN(test_printed_options_are_read_back_to_the_same_bytes);
    RUN(test_only_changed_options_are_printed);
    RUN(test_widths_follow_prusaslicers_rules);
    RUN(test_speeds_follow_prusaslicers_rules);
    RUN(test_percent_of_the_first_layer_is_of_each_speed);
    RUN(test_heights_centre_and_overlap);
    RUN(test_options_that_do_not_go_together_are_refused);
    RUN(test_placeholders_are_filled_in);
    RUN(test_placeholders_of_a_layer);
    RUN(test_density_of_a_lattice_in_any_locale);
    RUN(test_misspelt_words_are_near_and_others_are_not);
    return check_verdict();
}
