// Elo ratings by maximum likelihood of the Bradley-Terry model, with the minorisation of Hunter (Annals of
// Statistics 32, 2004): each player's strength becomes his points over the sum of games / (own + other strength).
#include <math.h>

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
