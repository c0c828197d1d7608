// Elo ratings by maximum likelihood of the Bradley-Terry model, with the minorisation of Hunter (Annals of
// Statistics 32, 2004): each player's strength becomes his points over the sum of games / (own + other strength).
#include <math.h>
#include <stdlib.h>

#include "vsss/eval.h"

#define VIRTUAL_GAMES 1 // per pair that played: one draw
#define ROUNDS        10000
#define TOLERANCE     1e-12 // of the logarithm of a strength

static double better_log_strength(int n, int i, const double *points, const int *games, const double *log_strength) {
  double won = 0.0, weight = 0.0, own = exp(log_strength[i]);
  for (int j = 0; j < n; j++) {
    if (j == i || games[i * n + j] == 0) continue;
    won += points[i * n + j] + 0.5 * VIRTUAL_GAMES;
    weight += (games[i * n + j] + VIRTUAL_GAMES) / (own + exp(log_strength[j]));
  }
  return weight > 0.0 ? log(won / weight) : log_strength[i];
}

void vs_elo(int n, const double *points, const int *games, double *rating) {
  for (int i = 0; i < n; i++) rating[i] = 0.0; // logarithms of the strengths until the end
  for (int round = 0; round < ROUNDS; round++) {
    double change = 0.0, mean = 0.0;
    for (int i = 0; i < n; i++) {
      double better = better_log_strength(n, i, points, games, rating);
      change = fmax(change, fabs(better - rating[i]));
      rating[i] = better;
    }
    for (int i = 0; i < n; i++) mean += rating[i] / n;
    for (int i = 0; i < n; i++) rating[i] -= mean;
    if (change < TOLERANCE) break;
  }
  for (int i = 0; i < n; i++) rating[i] *= 400.0 / log(10.0);
}

// The matrix of the likelihood's second derivatives by the logarithms of the strengths, which is singular (all may be
// shifted alike), with 1/n added everywhere, which mends that and adds 1/n to every entry of the inverse.
static void information(int n, const int *games, const double *rating, double *matrix) {
  for (int i = 0; i < n * n; i++) matrix[i] = 1.0 / n;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      if (i == j || games[i * n + j] == 0) continue;
      double p = 1.0 / (1.0 + pow(10.0, (rating[j] - rating[i]) / 400.0));
      double weight = (games[i * n + j] + VIRTUAL_GAMES) * p * (1.0 - p);
      matrix[i * n + i] += weight;
      matrix[i * n + j] -= weight;
    }
}

// Gauss and Jordan with pivots on the diagonal: the matrix is positive definite where all players are connected.
static void invert(int n, double *a, double *inverse) {
  for (int i = 0; i < n * n; i++) inverse[i] = i % (n + 1) == 0;
  for (int k = 0; k < n; k++) {
    double pivot = fabs(a[k * n + k]) > 1e-12 ? a[k * n + k] : 1e-12;
    for (int j = 0; j < n; j++) a[k * n + j] /= pivot, inverse[k * n + j] /= pivot;
    for (int i = 0; i < n; i++) {
      double factor = a[i * n + k];
      for (int j = 0; i != k && j < n; j++) {
        a[i * n + j] -= factor * a[k * n + j];
        inverse[i * n + j] -= factor * inverse[k * n + j];
      }
    }
  }
}

vs_status vs_elo_deviations(int n, const int *games, const double *rating, double *deviation, vs_error *err) {
  double *matrix = calloc(2 * (size_t)n * (size_t)n, sizeof *matrix);
  if (!matrix) return vs_fail(err, VS_FAIL, "out of memory for %d players", n);
  double *inverse = matrix + n * n;
  information(n, games, rating, matrix);
  invert(n, matrix, inverse);
  for (int i = 0; i < n; i++) {
    bool played = false;
    for (int j = 0; j < n; j++) played |= j != i && games[i * n + j] > 0;
    deviation[i] = played ? sqrt(fmax(inverse[i * n + i] - 1.0 / n, 0.0)) * 400.0 / log(10.0) : NAN;
  }
  free(matrix);
  return VS_OK;
}
