// Tests src/learn/beta.c
// Reference values by mpmath with 30 digits: loggamma, psi, and the entropy by numerical integration of -p ln p.
#include "assert_near.h"
#include "learn/beta.h"

static void gamma_functions_agree_with_the_references(void **state) {
  (void)state;
  static const double known[][4] = {
      {1.0, 0.0, -0.57721566490153286, 1.6449340668482264},
      {1.5, -0.12078223763524522, 0.036489973978576521, 0.93480220054467931},
      {2.7, 0.43482055365510453, 0.79678316899114102, 0.44721206891832364},
      {4.0, 1.791759469228055, 1.2561176684318005, 0.28382295573711533},
      {9.25, 11.143400119951712, 2.1695966825786159, 0.11416188455670626},
      {60.0, 184.53382886144949, 4.0859880813835383, 0.016806327117635388},
      {1000.0, 5905.2204232091812, 6.9072551956488121, 0.0010005001666666333},
  };
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    vs_gamma_values v = vs_gamma_at(known[i][0]);
    assert_near(v.log_gamma, known[i][1], 1e-10 * fmax(1.0, known[i][1]));
    assert_near(v.digamma, known[i][2], 1e-10);
    assert_near(v.trigamma, known[i][3], 1e-10);
  }
}

// alpha, beta, u, ln density, entropy.
static const double distributions[][5] = {
    {1.0, 1.0, 0.3, 0.0, 0.0},
    {1.7, 1.7, 0.25, 0.112159951116703, -0.0785155085255941},
    {4.0, 4.0, 0.9, -2.28219440334631, -0.384499565466447},
    {2.5, 7.25, 0.125, 0.951603102416284, -0.655807226235055},
    {60.0, 30.0, 0.7, 1.90292910342421, -1.59050800921384},
    {1.01, 12.0, 1e-7, 2.3546788481644, -1.55952563613759},
};

static void density_and_entropy_agree_with_the_references(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof distributions / sizeof *distributions; i++) {
    const double *d = distributions[i];
    vs_beta_terms terms = vs_beta_evaluate(d[0], d[1], log(d[2]), log1p(-d[2]));
    assert_near(terms.log_p, d[3], 1e-9);
    assert_near(terms.entropy, d[4], 1e-9);
  }
}

static void derivatives_agree_with_finite_differences(void **state) {
  (void)state;
  const double h = 1e-5;
  for (size_t i = 1; i < sizeof distributions / sizeof *distributions; i++) {
    double a = distributions[i][0], b = distributions[i][1], lu = log(distributions[i][2]),
           l1 = log1p(-distributions[i][2]);
    vs_beta_terms at = vs_beta_evaluate(a, b, lu, l1);
    vs_beta_terms more = vs_beta_evaluate(a + h, b, lu, l1), less = vs_beta_evaluate(a - h, b, lu, l1);
    assert_near(at.log_p_alpha, (more.log_p - less.log_p) / (2 * h), 1e-5);
    assert_near(at.entropy_alpha, (more.entropy - less.entropy) / (2 * h), 1e-5);
    more = vs_beta_evaluate(a, b + h, lu, l1), less = vs_beta_evaluate(a, b - h, lu, l1);
    assert_near(at.log_p_beta, (more.log_p - less.log_p) / (2 * h), 1e-5);
    assert_near(at.entropy_beta, (more.entropy - less.entropy) / (2 * h), 1e-5);
  }
}

// Mean a/(a+b), variance ab/((a+b)^2 (a+b+1)). With 40,000 samples the mean's own deviation is sqrt(variance)/200, so
// six deviations bound it; the seed is fixed.
static void samples_have_the_mean_and_variance_of_the_distribution(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(5, 0);
  enum { N = 40000 };
  for (size_t i = 0; i < sizeof distributions / sizeof *distributions; i++) {
    double a = distributions[i][0], b = distributions[i][1], sum = 0.0, squares = 0.0;
    for (int k = 0; k < N; k++) {
      double u = vs_beta_sample(a, b, &rng);
      assert_true(u >= VS_BETA_EDGE && u <= 1.0 - VS_BETA_EDGE);
      sum += u, squares += u * u;
    }
    double mean = sum / N, variance = squares / N - mean * mean;
    double true_variance = a * b / ((a + b) * (a + b) * (a + b + 1.0));
    assert_near(mean, a / (a + b), 6.0 * sqrt(true_variance / N));
    assert_near(variance / true_variance, 1.0, 0.06);
  }
}

// softplus(0) = ln 2; far out it is x, or e^x.
static void softplus_is_exact_far_from_zero(void **state) {
  (void)state;
  assert_near(vs_softplus(0.0), 0.69314718055994531, 1e-15);
  assert_near(vs_softplus(800.0), 800.0, 1e-12);
  assert_near(vs_softplus(-40.0) / exp(-40.0), 1.0, 1e-12);
  assert_near(vs_sigmoid(-800.0), 0.0, 1e-300);
  assert_near(vs_sigmoid(0.0), 0.5, 0.0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(gamma_functions_agree_with_the_references),
      cmocka_unit_test(density_and_entropy_agree_with_the_references),
      cmocka_unit_test(derivatives_agree_with_finite_differences),
      cmocka_unit_test(samples_have_the_mean_and_variance_of_the_distribution),
      cmocka_unit_test(softplus_is_exact_far_from_zero),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
