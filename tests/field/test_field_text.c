/* What is said of texts that are no fields. */
#include "field/fields.h"

#include "base/memory.h"

static void test_mistakes(void) {
    static const struct {
        const char *text, *message;
    } mistake[] = {
        {"", "column 1: expected a number, a name or '(', not the end"},
        {"z +", "column 4: expected a number, a name or '(', not the end"},
        {"z + w", "column 5: there is no variable 'w'; there are pi, x, y, z"},
        {"geodesic", "column 1: there is no variable 'geodesic'; there are pi, x, y, z"},
        {"ball:1,2,3", "column 1: there is no field 'ball:'; there are plane, cylinder, cone, "
                       "sphere, torus, wave, fan"},
        {"  Plane:0,0,1", "column 3: there is no field 'Plane:'; there are plane, cylinder, cone, "
                          "sphere, torus, wave, fan"},
        {"plane:", "column 7: expected a number, not the end"},
        {"plane:0,0", "column 10: expected ',' and a number as in plane:nx,ny,nz, not the end"},
        {"plane:0,0,", "column 11: expected a number, not the end"},
        {"plane:0,0,1,", "column 12: expected ',' or the end as in plane:nx,ny,nz, not ','"},
        {"plane:0,0,1,2", "column 12: expected ',' or the end as in plane:nx,ny,nz, not ','"},
        {"plane:0,0,1mm", "column 12: expected ',' or the end as in plane:nx,ny,nz, not 'm'"},
        {"plane:0 0 1", "column 9: expected ',' or the end as in plane:nx,ny,nz, not '0'"},
        {"plane:0,0,0", "column 7: a plane needs a direction other than 0,0,0"},
        {"plane:0,nan,0", "column 9: expected a number, not 'n'"},
        {"plane:0,0,1e9", "column 11: numbers go up to 1000000"},
        {"plane:0,0,1e", "column 13: expected digits of the exponent, not the end"},
        {"sphere:1,2", "column 11: expected ',' and a number as in sphere:x,y,z, not the end"},
        {"sphere:--1,2,3", "column 9: expected a number, not '-'"},
        {"cylinder:", "column 10: expected an axis: x, y or z, not the end"},
        {"cylinder:w", "column 10: expected an axis: x, y or z, not 'w'"},
        {"cylinder:xy", "column 11: expected ',' or the end as in cylinder:AXIS[,c,c], not 'y'"},
        {"cylinder:x,1",
         "column 13: expected ',' and a number as in cylinder:AXIS[,c,c], not the end"},
        {"cone:90", "column 6: the slope of a cone is -89 to 89 degrees"},
        {"cone:30,1", "column 10: expected ',' and a number as in cone:SLOPE[,x,y], not the end"},
        {"torus:-3", "column 7: the radius of a torus is 0.001 mm at least"},
        {"torus:3,1,2", "column 12: expected ',' and a number as in torus:R[,x,y,z], not the end"},
        {"wave:1,0", "column 8: the length of a wave is 0.001 mm at least"},
        {"wave:1",
         "column 7: expected ',' and a number as in wave:AMPLITUDE,LENGTH[,DIRECTION], not the end"},
        {"fan:y,1,2,0", "column 11: the radius of a fan is 0.001 mm at least, or -0.001 at most"},
        {"fan:y", "column 6: expected ',' and a number as in fan:AXIS,c,c,R, not the end"},
        {"fan:1,2,3", "column 5: expected an axis: x, y or z, not '1'"},
        {"plane:0,0,1\xff",
         "column 12: expected ',' or the end as in plane:nx,ny,nz, not a byte 255"},
        {":1", "column 1: expected a number, a name or '(', not ':'"},
    };
    for (int i = 0; i < (int)(sizeof mistake / sizeof *mistake); i++) {
        iso_field *field = NULL;
        CHECK_STATUS(ISO_BAD_CONFIG, iso_field_new(&field, mistake[i].text));
        CHECK(field == NULL);
        if (!CHECK(!strcmp(mistake[i].message, iso_error_message())))
            fprintf(stderr, "%s: %s\n", mistake[i].text, iso_error_message());
    }
}

/* What may be left out, and blanks. */
static void test_spellings(void) {
    static const char *const same[][2] = {
        {"cone:30", " cone: 30.0 ,+0 ,-0 "},
        {"cylinder:y", "cylinder: y ,0,0\n"},
        {"torus:5", "torus:5e0,0,0,0"},
        {"wave:1,8", "wave:1,8,0"},
        {"wave:1,8,90", "z + sin(pi/4*y)"},
        {"plane:1,1,0", "plane:2,2,0"},
        {"x ? y : z", "x?y:z"},
    };
    uint64_t state = 1;
    for (int k = 0; k < (int)(sizeof same / sizeof *same); k++) {
        iso_field *a = field_of(same[k][0]), *b = field_of(same[k][1]);
        for (int i = 0; i < 100; i++) {
            iso_vec3 p = point_within(&state, 20);
            if (!CHECK_NEAR(value_at(a, p), value_at(b, p), 1e-13))
                fprintf(stderr, "%s\n", same[k][0]);
        }
        iso_field_free(a);
        iso_field_free(b);
    }
}

/* A root of more squares than the stack could be walked down along. */
static void test_long_sum(void) {
    enum { SQUARES = 200000, START = 5, EACH = 4 };
    char *text;
    CHECK_OK(ISO_ALLOCATE(text, START + EACH * SQUARES + 1));
    memcpy(text, "sqrt(", START);
    for (int32_t i = 0; i < SQUARES; i++)
        memcpy(text + START + (int64_t)EACH * i, "x*x+", EACH);
    memcpy(text + START + (int64_t)EACH * SQUARES - 1, ")", 2);
    iso_field *field = field_of(text);
    CHECK_NEAR(3 * sqrt(SQUARES), value_at(field, (iso_vec3){-3, 1, 2}), 1e-6);
    CHECK_NEAR(-sqrt(SQUARES), gradient_at(field, (iso_vec3){-3, 1, 2}).x, 1e-6);
    iso_field_free(field);
    iso_release(text);
}

int main(void) {
    RUN(test_mistakes);
    RUN(test_spellings);
    RUN(test_long_sum);
    return check_verdict();
}
