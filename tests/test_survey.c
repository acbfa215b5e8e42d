/* What a survey cell knows of the steps of the stress that its front has passed. */
#include "base/tuning.h"
#include "check.h"
#include "front/survey.h"

static survey_cell beyond_two_steps(double s) {
    return (survey_cell){.s = s,
                         .h = 0.5,
                         .w_tip = 1e15, /* so wide that no step takes a part of it */
                         .step_count = 2,
                         .step = {{.height = 2, .depth = -0.3}, {.height = -1, .depth = 0.2}}};
}

/* Zero until the front is there, then less than the distance, by half where that is the softness.
 */
static void depths_begin_softly(void **unused) {
    (void)unused;
    const double soft = ILSAI_STRESS_STEP_SOFT * 0.5;
    for (double s = 0.01; s < 0.3; s += 0.01) {
        const survey_cell survey = beyond_two_steps(s);
        const step_depth d = ilsai_survey_step_depth(&survey, 0);
        assert_true(d.value == 0 && d.by_s == 0);
        assert_true(ilsai_survey_step_depth(&survey, 1).value > 0);
    }
    const survey_cell near = beyond_two_steps(0.3 + soft), far = beyond_two_steps(1e9);
    assert_below(relative(ilsai_survey_step_depth(&near, 0).value, 0.5 * soft), 1e-12);
    assert_below(relative(ilsai_survey_step_depth(&far, 0).value, 1e9), 1e-8);
    assert_near(ilsai_survey_step_depth(&far, 0).by_s, 1, 1e-8);
}

static void depths_grow_as_their_derivative_says(void **unused) {
    (void)unused;
    const double small = 1e-6;
    double worst = NOTHING_YET;
    for (double s = 0.305; s < 4; s *= 1.02)
        for (int k = 0; k < 2; k++) {
            const survey_cell here = beyond_two_steps(s), less = beyond_two_steps(s - small),
                              more = beyond_two_steps(s + small);
            const double rise =
                ilsai_survey_step_depth(&more, k).value - ilsai_survey_step_depth(&less, k).value;
            worst =
                worst_of(worst, fabs(rise / (2 * small) - ilsai_survey_step_depth(&here, k).by_s));
        }
    print_message("survey: derivative of the depth beyond a step %.1e off\n", worst);
    assert_below(worst, 1e-7);
}

/* The sum over the steps of height and width, nothing of those that are ahead. */
static void widths_of_steps_add_up(void **unused) {
    (void)unused;
    const survey_cell one = beyond_two_steps(0.2), both = beyond_two_steps(0.9);
    for (double s = 0.1; s < 3; s *= 1.5) {
        const double first = ilsai_stress_step_width(s, ilsai_survey_step_depth(&both, 0).value);
        const double second = ilsai_stress_step_width(s, ilsai_survey_step_depth(&both, 1).value);
        const double alone = ilsai_stress_step_width(s, ilsai_survey_step_depth(&one, 1).value);
        assert_true(first > 0 && second > 0 && alone > 0);
        assert_below(relative(ilsai_survey_step_width(&both, s), 2 * first - second), 1e-14);
        assert_below(relative(ilsai_survey_step_width(&one, s), -alone), 1e-14);
    }
}

/* A lower stress around the front leaves a part of the asymptote's width, however deep the drop. */
static void a_drop_leaves_a_width(void **unused) {
    (void)unused;
    for (double height = 1e-6; height < 1e9; height *= 10) {
        survey_cell survey = {.s = 0.9, .h = 0.5, .w_tip = 0.7, .step_count = 1};
        survey.step[0] = (stress_step){.height = -height, .depth = -0.3};
        const double depth = ilsai_survey_step_depth(&survey, 0).value;
        const double alone = height * ilsai_stress_step_width(survey.s, depth);
        const double left = survey.w_tip + ilsai_survey_step_width(&survey, survey.s);
        assert_below(relative(left, survey.w_tip / (1 + alone / survey.w_tip)), 1e-6);
        assert_true(left > 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(depths_begin_softly),
        cmocka_unit_test(depths_grow_as_their_derivative_says),
        cmocka_unit_test(widths_of_steps_add_up),
        cmocka_unit_test(a_drop_leaves_a_width),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
