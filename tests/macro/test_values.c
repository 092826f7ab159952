/* Expressions and their results: what PrusaSlicer 2.5 prints where it knows them. */
#include <stdlib.h>

#include "macro/datum.h"
#include "macro_case.h"

/* ---- arithmetic ---- */

static void test_whole_numbers_stay_whole(void) {
    static const macro_case cases[] = {{"{1+2}", "3"},
                                       {"{7/2}", "3"},
                                       {"{-7/2}", "-3"},
                                       {"{7%3}", "1"},
                                       {"{-7%3}", "-1"},
                                       {"{1-1-1}", "-1"},
                                       {"{2*3+4}", "10"},
                                       {"{2+3*4}", "14"},
                                       {"{-2*3}", "-6"},
                                       {"{10-(2-3)}", "11"},
                                       {"{--5}", "5"},
                                       {"{+5}", "5"},
                                       {"{ ( 1 ) }", "1"},
                                       {"{2147483647}", "2147483647"},
                                       {"{-2147483647-1}", "-2147483648"},
                                       {"{100000*10}", "1000000"}};
    CHECK_CASES(cases);
}

static void test_numbers_with_a_point_have_six_digits(void) {
    static const macro_case cases[] = {{"{7/2.0}", "3.5"},
                                       {"{7.5%2}", "1.5"},
                                       {"{1/3.0}", "0.333333"},
                                       {"{1000000.0}", "1e+06"},
                                       {"{1234567.5}", "1.23457e+06"},
                                       {"{0.1+0.2}", "0.3"},
                                       {"{1e-5}", "1e-05"},
                                       {"{0.00001}", "1e-05"},
                                       {"{1.0}", "1"},
                                       {"{5.}", "5"},
                                       {"{.5}", "0.5"},
                                       {"{12345.678}", "12345.7"},
                                       {"{123456.7}", "123457"},
                                       {"{0.0001234567}", "0.000123457"},
                                       {"{3.14159265358979}", "3.14159"},
                                       {"{1e3}", "1000"},
                                       {"{-0.0}", "-0"},
                                       {"{2.5e2}", "250"}};
    CHECK_CASES(cases);
}

/* The C library writes %g in the C locale, which the tests run in. */
static void test_written_numbers_are_those_of_printf(void) {
    uint64_t state = 1;
    for (int i = 0; i < 200000; i++) {
        char ours[ISO_DATUM_TEXT_SIZE], theirs[64];
        state = state * 6364136223846793005u + 1442695040888963407u;
        double number = (double)(int64_t)(state >> 20) - 8796093022208.0;
        for (int power = (int)(state >> 5 & 31); power > 0; power--)
            number /= 10;
        iso_datum_write_number(ours, number);
        snprintf(theirs, sizeof theirs, "%g", number);
        if (!CHECK(strcmp(ours, theirs) == 0))
            fprintf(stderr, "%s is not %s\n", ours, theirs);
    }
}

static void test_read_numbers_are_those_of_strtod(void) {
    uint64_t state = 7;
    for (int i = 0; i < 200000; i++) {
        char text[64];
        iso_datum number;
        int32_t used;
        state = state * 6364136223846793005u + 1442695040888963407u;
        int length = snprintf(text, sizeof text, "%llu.%03llu", (unsigned long long)(state >> 44),
                              (unsigned long long)(state % 1000));
        CHECK(iso_datum_read_number(&number, text, length, &used));
        CHECK_EQUAL(length, used);
        CHECK(number.number == strtod(text, NULL));
    }
}

static void test_functions(void) {
    static const macro_case cases[] = {
        {"{round(2.5)} {round(-2.5)} {round(2.4)} {round(7)}", "3 -3 2 7"},
        {"{int(2.9)} {int(-2.9)} {int(4)}", "2 -2 4"},
        {"{min(1,2.0)} {max(1,2)} {min(1.5,2)} {max(3,1,2)}", "1 2 1.5 3"},
        {"{min(1,2.0)/2} {min(1,2)/2}", "0.5 0"},
        {"{abs(-2)} {abs(-2.5)}", "2 2.5"},
        {"{digits(5,3)}|{zdigits(5,3)}|{digits(5.678,8,2)}|{zdigits(5.678,8,2)}",
         "  5|005|    5.68|00005.68"},
        {"{digits(-5.678,8,2)}|{zdigits(-5.5,8,1)}|{digits(5.678,3)}", "   -5.68|-00005.5|  6"},
        {"{random(3,3)} {random(1.5,1.5)}", "3 1.5"},
        {"{interpolate_table(5,(0,0),(10,20))}", "10"},
        {"{interpolate_table(-1,(0,1),(10,20))} {interpolate_table(11,(0,1),(10,20.5))}", "1 20.5"},
        {"{interpolate_table(25, (0, 10), (20, 20), (30, 40))}", "30"},
        {"{one_of(\"PETG\",\"PLA\",\"PETG\")} {one_of(\"PETG\",\"PLA\",/P.*/)}", "true true"},
        {"{one_of(3,1,2)} {one_of(3, 1, 3.0)}", "false true"},
        {"{size(\"abc\")} {empty(\"\")} {empty(\"a\")}", "3 true false"},
        {"{size(repeat(4, 1.5))} {size(temperature)}", "4 1"},
        {"{size(layer_heights)} {empty(layer_heights)}", "0 true"},
        {"{is_nil(filament_retract_length[0])} {is_nil(temperature[0])}", "true false"}};
    CHECK_CASES(cases);
}

static void test_random_numbers_are_the_same_every_time(void) {
    static char first[sizeof expanded];
    const char *text = "{random(0,1000000)} {random(0.0,1.0)}";
    CHECK_OK(expand_case(text));
    strcpy(first, expanded);
    CHECK_OK(expand_case(text));
    CHECK(strcmp(first, expanded) == 0);
    iso_macro_scope scope = {&options, NULL, NULL, 0, NULL};
    CHECK_OK(iso_macro_expand(expanded, sizeof expanded, text, "layer_gcode", &scope));
    CHECK(strcmp(first, expanded) != 0);
    int seen[6] = {0};
    CHECK_OK(expand_case("{random(1,5)}"));
    for (int i = 0; i < 200; i++) {
        iso_macro_number number = {"layer_num", i, true};
        scope.number = &number;
        scope.number_count = 1;
        CHECK_OK(
            iso_macro_expand(expanded, sizeof expanded, "{random(1,5)}", "layer_gcode", &scope));
        int value = atoi(expanded);
        if (CHECK(value >= 1 && value <= 5))
            seen[value]++;
    }
    for (int value = 1; value <= 5; value++)
        CHECK(seen[value] > 20);
}

/* ---- truth and texts ---- */

static void test_conditions(void) {
    static const macro_case cases[] = {
        {"{1==1.0} {1!=2} {1<>2} {(1<2)} {2<=2} {3>2} {2>=3}",
         "true true true true true true false"},
        {"{0.1+0.2==0.3} {1==1==true}", "true true"},
        {"{not (1==2)} {!(1==2)} {not not true}", "true true true"},
        {"{true and false or true} {true || false && false}", "true true"},
        {"{1<2 ? 3 : 4} {1>2 ? 3 : 4} {false ? 1 : true ? 2 : 3}", "3 4 2"},
        {"{true or 1/0 == 1} {false and nothing}", "true false"},
        {"{true ? 1 : 1/0}", "1"},
        {"{true == false}", "false"}};
    CHECK_CASES(cases);
}

static void test_texts(void) {
    static const macro_case cases[] = {
        {"{\"a\"+1+2.5+true}", "a12.5true"},
        {"{1+\"a\"}", "1a"},
        {"{1+2+\"a\"+1+2}", "3a12"},
        {"{\"a\\\"b\\\\c\\n\"}", "a\"b\\c\n"},
        {"{\"{[\"}", "{["},
        {"{\"b\">\"a\"} {\"b\">=\"a\"} {\"10\"<\"9\"} {\"ab\">\"a\"}", "true true true true"},
        {"{1==\"1\"} {1.50==\"1.5\"}", "true true"},
        {"{\"abc\"=~/a.c/} {\"abc\"!~/b/} {\"abc\" =~ /.*b.*/}", "true true true"},
        {"{\"\xC3\xA9\"}", "\xC3\xA9"}};
    CHECK_CASES(cases);
}

/* ---- names ---- */

static void test_options_have_their_kinds(void) {
    options.temperature = 215;
    options.fill_density = 12.5;
    static const macro_case cases[] = {
        {"{temperature} {temperature[0]} {temperature[5]} {temperature[-1]}", "215 215 215 215"},
        {"[temperature] [temperature_0] [temperature_7] [ temperature ]", "215 215 215 215"},
        {"[temperature[current_extruder]] [temperature_[current_extruder]] [temperature[0]]",
         "215 215 215"},
        {"{temperature [ initial_extruder ]} {temperature/2}", "215 107"},
        {"{spiral_vase} [spiral_vase] {spiral_vase ? 1 : 2}", "false 0 2"},
        {"{fill_density} [fill_density] {fill_density*2}", "12.5 12.5% 25"},
        {"{external_perimeter_speed} [external_perimeter_speed]", "30 50%"},
        {"{external_perimeter_extrusion_width} [external_perimeter_extrusion_width]", "0.45 0"},
        {"{first_layer_extrusion_width} {top_infill_extrusion_width}", "0.7 0.4"},
        {"{infill_anchor} {infill_overlap}", "2.7 0.1125"},
        {"{first_layer_height} [first_layer_height] {nozzle_diameter[0]*1.5}", "0.35 0.35 0.6"},
        {"[fill_pattern] {fill_pattern + \"!\"}", "rectilinear rectilinear!"},
        {"{bed_shape[1]} [bed_shape] [bed_shape_2] {size(bed_shape)}", "[200, 0] 0,0 200,200 4"},
        {"{print_bed_min[0]} {print_bed_max[1]} {print_bed_size[0]}", "0 200 200"}};
    CHECK_CASES(cases);
}

static void test_the_job_has_names(void) {
    static const macro_case cases[] = {
        {"{input_filename} {input_filename_base}", "part.one.gcode part.one"},
        {"{timestamp} {year} {month} {day} {hour} {minute} {second}",
         "20261122-035918 2026 11 22 3 59 18"},
        {"{num_objects} {num_instances} {total_layer_count}", "2 3 40"},
        {"{first_layer_print_min[0]} {first_layer_print_max[1]} {first_layer_print_size[1]}",
         "95 112.5 22.5"},
        {"[first_layer_print_min] [first_layer_print_min_1]", "95 90"},
        {"{first_layer_print_convex_hull[2]} {size(first_layer_print_convex_hull)}",
         "[100, 112.5] 3"},
        {"{layer_num} {layer_z} {max_layer_z} [layer_z] {layer_num/2} {layer_z/2}",
         "7 2.45 2.45 2.45 3 1.225"},
        {"{initial_extruder}{initial_tool}{current_extruder} {num_extruders}", "000 1"},
        {"{has_wipe_tower} [has_wipe_tower] {is_extruder_used[0]} {total_toolchanges}",
         "false 0 true 0"},
        {"{if not has_single_extruder_multi_material_priming}M109{endif}", "M109"},
        {"{scale[0]}|{physical_printer_preset}|", "x:100% y:100% z:100%||"},
        {"{initial_filament_type}", "PLA"}};
    CHECK_CASES(cases);
}

static void test_keys_of_files_have_prusaslicers_kinds(void) {
    iso_foreign *foreign = &options.foreign;
    CHECK(iso_foreign_set(foreign, "printer_notes", "line one\\nPRINTER_MODEL_MINI\\n"));
    CHECK(iso_foreign_set(foreign, "filament_type", "PLA;\"P;\\\"E\\\"\";FLEX"));
    CHECK(iso_foreign_set(foreign, "raft_layers", "2"));
    CHECK(iso_foreign_set(foreign, "support_material", "1"));
    CHECK(iso_foreign_set(foreign, "support_material_speed", "40"));
    CHECK(iso_foreign_set(foreign, "support_material_interface_speed", "80%"));
    CHECK(iso_foreign_set(foreign, "extruder_offset", "0x0,18x-0.5"));
    CHECK(iso_foreign_set(foreign, "filament_loading_speed", "28,14"));
    CHECK(iso_foreign_set(foreign, "retract_length_toolchange", "-4"));
    CHECK(iso_foreign_set(foreign, "new_number", "3"));
    CHECK(iso_foreign_set(foreign, "new_list", "1.5,2"));
    CHECK(iso_foreign_set(foreign, "new_text", "a\\\\b"));
    static const macro_case cases[] = {
        {"{if printer_notes=~/.*PRINTER_MODEL_MINI.*/}mini{else}other{endif}", "mini"},
        {"{filament_type[0]} {filament_type[1]} {filament_type[9]} [filament_type_2]",
         "PLA P;\"E\" PLA FLEX"},
        {"{size(filament_type)}", "3"},
        {"{raft_layers/2} {raft_layers+1}", "1 3"},
        {"{support_material} [support_material]", "true 1"},
        {"{support_material_interface_speed} [support_material_interface_speed]", "32 80%"},
        {"{extruder_offset[1]} [extruder_offset_1]", "[18, -0.5] 18,-0.5"},
        {"{filament_loading_speed[1]/4} {retract_length_toolchange[0]}", "3.5 -4"},
        {"{new_number*2} {new_list[0]} {new_text}", "6 1.5 a\\b"},
        {"{printer_model}|{printer_settings_id}|{filament_notes[0]}|", "|||"},
        {"{single_extruder_multi_material} {filament_vendor[0]}", "false (Unknown)"},
        {"{print_preset}{printer_preset}", ""}};
    CHECK_CASES(cases);
    memset(foreign, 0, sizeof *foreign);
}

/* It is searched by halves. */
static void test_the_table_of_keys_is_in_order(void) {
    static const char *const keys[] = {
#define ISO_KEY(key, kind, initial) #key,
#include "macro/keys.inl"
#undef ISO_KEY
    };
    for (size_t i = 1; i < sizeof keys / sizeof *keys; i++)
        if (!CHECK(strcmp(keys[i - 1], keys[i]) < 0))
            fprintf(stderr, "  %s\n", keys[i]);
}

int main(void) {
    iso_options_defaults(&options);
    CHECK_OK(iso_options_set(&options, "fill_pattern", "rectilinear", "test"));
    RUN(test_whole_numbers_stay_whole);
    RUN(test_numbers_with_a_point_have_six_digits);
    RUN(test_written_numbers_are_those_of_printf);
    RUN(test_read_numbers_are_those_of_strtod);
    RUN(test_functions);
    RUN(test_random_numbers_are_the_same_every_time);
    RUN(test_conditions);
    RUN(test_texts);
    RUN(test_options_have_their_kinds);
    RUN(test_the_job_has_names);
    RUN(test_keys_of_files_have_prusaslicers_kinds);
    RUN(test_the_table_of_keys_is_in_order);
    iso_macro_globals_free(&globals);
    return check_verdict();
}
