/* Texts with macros: conditions, variables, messages, limits. */
#include <stdlib.h>

#include "base/memory.h"
#include "macro_case.h"

static void test_text_is_copied(void) {
    static const macro_case cases[] = {
        {"", ""},
        {"G28\nG1 X0 ; home\n", "G28\nG1 X0 ; home\n"},
        {"a}b]c", "a}b]c"},
        {"\n \t G28 \n", "G28 \n"}, /* as PrusaSlicer does */
        {"M104 S{200+5}\nM140 S[bed_temperature]", "M104 S205\nM140 S0"},
        {"{1}{2} {\n3\n}", "12 3"}};
    CHECK_CASES(cases);
}

static void test_conditions_choose_text(void) {
    static const macro_case cases[] = {
        {"a{if 1==1}yes{endif}b", "ayesb"},
        {"a{if 1==2}yes{endif}b", "ab"},
        {"{if 1==2}a{elsif 2==2}b{else}c{endif}", "b"},
        {"{if 1==2}a{elsif 2==3}b{elsif true}d{else}c{endif}", "d"},
        {"{if 1==2}a{elsif 2==3}b{else}c{endif}", "c"},
        {"{if true}{if false}a{else}b{endif}{else}c{endif}", "b"},
        {"{if true}a{elsif true}b{elsif true}c{endif}", "a"},
        {"{if false}{if true}a{else}b{endif}{else}c{if true}d{endif}e{endif}", "cde"},
        {"{if false}{nothing}[nothing]{1/0}{1+true}{endif}x", "x"},
        {"{if 1 == 1}\nG28\n{endif}\nG1", "\nG28\n\nG1"},
        {"{if layer_num == 7 && layer_z < max_print_height}\nM117 {layer_num}{endif}", "\nM117 7"},
        {"{if true}{else}{endif}", ""}};
    CHECK_CASES(cases);
}

static void test_conditions_choose_statements(void) {
    static const macro_case cases[] = {
        {"{if 1 == 2 then \"a\" else \"b\" endif}", "b"},
        {"{if false then elsif true then \"hello\" endif}", "hello"},
        {"{if false then elsif false then else endif}", ""},
        {"{local x = 2; if x == 1 then \"one\"; elsif x == 2 then \"two\"; 2 endif; \"!\"}",
         "two2!"},
        {"{if true then if false then 1 else 2 endif endif}", "2"},
        {"{local x = 1; if x == 1}text{endif}", "text"}};
    CHECK_CASES(cases);
}

static void test_variables(void) {
    static const macro_case cases[] = {
        {"{local x = 33+2}{x}", "35"},
        {"{local a = 1, b = 2.5, c = \"t\", d = a == 1}{a}{b}{c}{d}", "12.5ttrue"},
        {"{local x = 1}{x = x + 4}{x}", "5"},
        {"{local x = 1; x = 2.9; x}", "2"},
        {"{local x = 1.5; x = 2; x/4}", "0.5"},
        {"{local x = \"a\"; x = 2; x + 1}", "21"},
        {"{local x = (1, 2, 3)}{x[1]} {size(x)}", "2 3"},
        {"{local x = repeat(3, \"a\"); x[1] = \"b\"; x[0] + x[1] + x[2]}", "aba"},
        {"{local x = (1, 2, 3, 4, 5, 6, 7, 8, 9); x[8] + x[0]}", "10"},
        {"{if true}{local x = 1}{else}{local x = 2}{endif}{x}", "1"},
        {"{local x = filament_type[0]; x}", "PLA"},
        {"{local x = temperature; x = x + 1; x}", "201"}};
    CHECK_CASES(cases);
    CHECK_STATUS(ISO_BAD_CONFIG, expand_case("{x}")); /* locals end with their text */
}

static void test_globals_last_from_text_to_text(void) {
    CHECK_OK(expand_case("{global count = 1, name = \"a\", list = (\"x\", \"y\")}"));
    for (int i = 0; i < 100; i++)
        CHECK_OK(expand_case("{count = count + 1; name = name + \"b\"; list[1] = name}"));
    CHECK_OK(expand_case("{count} {size(name)} {size(list[1])} {list[0]} {name=~/ab*/}"));
    CHECK(strcmp(expanded, "101 101 101 x true") == 0);
    CHECK_OK(expand_case("{global count = 7}{name = name}{count}"));
    CHECK(strcmp(expanded, "7") == 0);
    iso_macro_globals_free(&globals);
    CHECK_STATUS(ISO_BAD_CONFIG, expand_case("{count}"));
    iso_macro_scope scope = {&options, NULL, NULL, 0, NULL};
    CHECK_OK(iso_macro_expand(expanded, sizeof expanded, "{global x = 1}{x}", "t", &scope));
    CHECK_STATUS(ISO_BAD_CONFIG, iso_macro_expand(expanded, sizeof expanded, "{x}", "t", &scope));
}

/* ---- messages ---- */

static void test_messages_say_where_and_what(void) {
    static const macro_case cases[] = {
        {"G28\nG1 {1 +}", "2, column 8: expected a value, not }"},
        {"{(1}", "1, column 4: expected a ), not }"},
        {"{temperature[0}", "1, column 15: expected a ], not }"},
        {"{1 2}", "1, column 4: expected an operator or a }, not 2"},
        {"{}", "1, column 2: expected a value or a condition in the braces, not }"},
        {"{1", "1, column 3: expected an operator or a } before the end of the text"},
        {"[temperature", "1, column 13: expected a ] before the end of the text"},
        {"[]", "1, column 2: expected the name of an option or a variable behind the [, not ]"},
        {"\xC3\xA9{if 1}a{endif}", "1, column 6: expected true or false, not a number"},
        {"{if true}a",
         "1, column 11: expected {elsif}, {else} or {endif} before the end of the text"},
        {"{if true a{endif}", "1, column 10: expected a } behind the condition, not a"},
        {"{if true}a{else}b{else}c{endif}", "1, column 19: expected endif, not else"},
        {"a{endif}", "1, column 3: this endif has no if before it"},
        {"a{else}b", "1, column 3: this else has no if before it"},
        {"{\"abc}", "1, column 2: expected a \" at the end of this text"},
        {"{\"a\"=~\"b\"}", "1, column 7: expected a /regular expression/, not \""},
        {"{\"a\"=~/b}", "1, column 7: expected a / at the end of this regular expression"},
        {"{\"a\"=~/(b/}", "1, column 10: expected ) at the end of the group"},
        {"{1=~/b/}", "1, column 2: expected a text before =~ and !~, not a number"},
        {"{1/0}", "1, column 3: division by zero"},
        {"{5.0 % 0}", "1, column 6: division by zero"},
        {"{1+true}", "1, column 3: expected a number, not true or false"},
        {"{-\"a\"}", "1, column 2: expected a number, not a text"},
        {"{not 1}", "1, column 2: expected true or false behind not, not a number"},
        {"{1 and true}", "1, column 2: expected true or false, not a number"},
        {"{true < false}", "1, column 7: can't compare true or false with true or false"},
        {"{2147483648}", "1, column 2: 2147483648 is no number that fits"},
        {"{2147483647+1}", "1, column 12: 2147483648 does not fit into a whole number"},
        {"{min(1)}", "1, column 7: expected a , and another value, not )"},
        {"{abs(1,2)}", "1, column 8: abs takes no more than 1 value"},
        {"{abs(\"a\")}", "1, column 6: abs expects a number, not a text"},
        {"{abs 1}", "1, column 6: expected a ( behind the name of a function, not 1"},
        {"{digits(1,2.5)}", "1, column 11: digits expects a whole number, not a number"},
        {"{bed_shape}", "1, column 2: this is a list of 4 values; say which one, as [0]"},
        {"{layer_heights[0]}", "1, column 15: this list is empty"},
        {"[layer_heights]", "1, column 2: this list is empty"},
        {"{temperature[0.5]}",
         "1, column 14: expected a whole number in [ ], not one with a point"},
        {"{layer_hieght}", "1, column 2: there is no option or variable layer_hieght; is it "
                           "layer_height?"},
        {"[nothing]",
         "1, column 2: there is no option or variable nothing; if a profile should set "
         "it, it has no such line"},
        {"{used_filament}",
         "1, column 2: used_filament has no value here: it is known only when the "
         "print is done"},
        {"{x = 1}", "1, column 2: there is no variable x; write local x = ... first"},
        {"{temperature = 1}", "1, column 2: temperature can't be changed; only variables can"},
        {"{local temperature = 1}",
         "1, column 8: temperature has a value already; give the variable "
         "another name"},
        {"{local 5 = 1}", "1, column 8: expected the name of a variable, not 5"},
        {"{local x 1}", "1, column 10: expected a =, not 1"},
        {"{local x = true; x = 1}",
         "1, column 18: the variable holds true or false, so it can't be "
         "set to a number"},
        {"{local x = (1, 2); x[2] = 1}",
         "1, column 20: expected a whole number from 0 to 1 in [ ]"},
        {"{avoid_crossing_perimeters_max_detour}",
         "1, column 2: avoid_crossing_perimeters_max_detour is in percent of something that has no "
         "name; give it a number, or write [avoid_crossing_perimeters_max_detour] for its text"},
        {"{1e200*1e200}", "1, column 7: the result is too large"},
        {"{interpolate_table(1, (2, 3), (1, 4))}",
         "1, column 31: the rows of a table rise from left to right"}};
    CHECK_OK(iso_options_set(&options, "avoid_crossing_perimeters_max_detour", "50%", "test"));
    CHECK_REFUSED(cases);
    CHECK_OK(iso_options_set(&options, "avoid_crossing_perimeters_max_detour", "0", "test"));
}

/* What is left out must have the right form all the same. */
static void test_the_form_is_checked_everywhere(void) {
    static const char *const wrong[] = {"{if false}{1+}{endif}", "{if false}[1]{endif}",
                                        "{true ? 1 : }",         "{if false}{\"a\"=~/(/}{endif}",
                                        "{if true}{endif",       "{false and }"};
    static const char *const right[] = {"{if false}{nothing}{endif}", "[layer_num] {layer_z}",
                                        "{local x = 1}{x + y}", "{global z = (1, 2)}{z[0] = 3}"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        CHECK_STATUS(ISO_BAD_CONFIG, iso_macro_check(wrong[i], "layer_gcode"));
        CHECK_STATUS(ISO_BAD_CONFIG, expand_case(wrong[i]));
    }
    for (size_t i = 0; i < sizeof right / sizeof *right; i++)
        CHECK_OK(iso_macro_check(right[i], "layer_gcode"));
}

/* ---- limits ---- */

static void test_nesting_is_bounded(void) {
    static char text[1 << 17];
    static const char *const openings[] = {
        "(", "-", "!", "{if true}", "min(1,", "1+(", "{if true then ", "true ? "};
    for (size_t i = 0; i < sizeof openings / sizeof *openings; i++) {
        size_t length = 0, piece = strlen(openings[i]);
        bool braces = openings[i][0] == '{';
        if (!braces)
            text[length++] = '{';
        for (int n = 0; n < 5000; n++, length += piece)
            memcpy(text + length, openings[i], piece);
        text[length] = 0;
        CHECK_STATUS(ISO_BAD_CONFIG, expand_case(text));
        CHECK_STATUS(ISO_BAD_CONFIG, iso_macro_check(text, "start_gcode"));
        if (i < 2)
            CHECK(strstr(iso_error_message(), "nested deeper than 100") != NULL);
    }
    char deep[512] = "{";
    for (int n = 0; n < 40; n++)
        strcat(deep, "(");
    strcat(deep, "1");
    for (int n = 0; n < 40; n++)
        strcat(deep, ")");
    strcat(deep, "}");
    CHECK_OK(expand_case(deep));
    CHECK(strcmp(expanded, "1") == 0);
}

static void test_lengths_are_bounded(void) {
    char small[8];
    iso_macro_scope scope = {&options, &case_job, NULL, 0, NULL};
    CHECK_OK(iso_macro_expand(small, 8, "1234{567}", "t", &scope));
    CHECK(strcmp(small, "1234567") == 0);
    CHECK_STATUS(ISO_BAD_CONFIG, iso_macro_expand(small, 8, "1234{5678}", "t", &scope));
    CHECK_STATUS(ISO_BAD_CONFIG, iso_macro_expand(small, 8, "12345678", "t", &scope));
    static char text[1 << 15] = "{local x = \"0123456789\"";
    for (int n = 0; n < 20; n++)
        strcat(text, "; x = x + x");
    CHECK_STATUS(ISO_BAD_CONFIG, expand_case(strcat(text, "}")));
    CHECK(strstr(iso_error_message(), "more than 65535 bytes") != NULL);
    strcpy(text, "{local x = repeat(4096, 1)");
    for (int n = 0; n < 200; n++)
        strcat(text, "; x[1] = 2");
    CHECK_STATUS(ISO_BAD_CONFIG, expand_case(strcat(text, "}")));
    CHECK(strstr(iso_error_message(), "more than 8 MiB") != NULL);
    CHECK_STATUS(ISO_BAD_CONFIG, expand_case("{repeat(4097, 1)[0]}"));
    CHECK_STATUS(ISO_BAD_CONFIG,
                 expand_case("{a23456789b23456789c23456789d23456789e23456789f23456789g2345}"));
    strcpy(text, "{");
    for (int n = 0; n < 129; n++)
        snprintf(text + strlen(text), 32, "local v%d = 1; ", n);
    CHECK_STATUS(ISO_BAD_CONFIG, expand_case(strcat(text, "}")));
    CHECK(strstr(iso_error_message(), "more than 128 variables") != NULL);
}

/* ---- memory ---- */

static void test_every_allocation_may_fail(void) {
    const char *text = "{global kept = \"a\"; kept = kept + printer_notes}"
                       "{local x = repeat(2000, \"b\"); x[1999] = kept; x[1999]}";
    CHECK(iso_foreign_set(&options.foreign, "printer_notes", "some\\nnotes"));
    (void)iso_fail_allocation_after(INT64_MAX); /* counts, and lets all be */
    CHECK_OK(expand_case(text));
    iso_macro_globals_free(&globals);
    int64_t count = iso_fail_allocation_after(-1);
    CHECK(count >= 3);
    for (int64_t n = 0; n < count; n++) {
        (void)iso_fail_allocation_after(n);
        iso_status status = expand_case(text);
        (void)iso_fail_allocation_after(-1);
        CHECK_EQUAL(ISO_NO_MEMORY, status);
        iso_macro_globals_free(&globals);
    }
}

/* Texts as vendors write them, at every layer of a high print. */
static void test_thousands_of_layers_take_no_time(void) {
    static const char layer[] =
        ";LAYER:{layer_num}\n;Z:{layer_z}\n{if layer_z < max_print_height-10}M117 "
        "{digits(layer_z,1,2)} of {max_layer_z}{elsif printer_notes=~/.*MODEL_MINI.*/}"
        "G1 Z{z_offset+min(layer_z+70, max_print_height-10)}{else}{first_layer_temperature[0]}"
        "{endif}\n";
    (void)iso_fail_allocation_after(INT64_MAX);
    for (int i = 0; i < 5000; i++)
        CHECK_OK(expand_case(layer));
    CHECK_EQUAL(0, iso_fail_allocation_after(-1)); /* nothing is allocated for them */
    CHECK(strcmp(expanded, ";LAYER:7\n;Z:2.45\nM117 2.45 of 2.45\n") == 0);
}

int main(void) {
    iso_options_defaults(&options);
    RUN(test_text_is_copied);
    RUN(test_conditions_choose_text);
    RUN(test_conditions_choose_statements);
    RUN(test_variables);
    RUN(test_globals_last_from_text_to_text);
    RUN(test_messages_say_where_and_what);
    RUN(test_the_form_is_checked_everywhere);
    RUN(test_nesting_is_bounded);
    RUN(test_lengths_are_bounded);
    RUN(test_every_allocation_may_fail);
    RUN(test_thousands_of_layers_take_no_time);
    iso_macro_globals_free(&globals);
    return check_verdict();
}
