#include "vsss/league_messages.h"

#include <math.h>

const char *vs_foul_name(vs_foul foul) {
  static const char *const name[VS_FOULS] = {"free kick", "penalty kick", "goal kick", "free ball",
                                             "kick-off",  "stop",         "game on",   "halt"};
  return foul >= 0 && foul < VS_FOULS ? name[foul] : "?";
}

// Calls that are about nothing but themselves may come again with another time.
static bool stands_alone(vs_foul foul) {
  return foul == VS_FOUL_STOP || foul == VS_FOUL_GAME_ON || foul == VS_FOUL_HALT;
}

bool vs_ref_command_repeats(const vs_ref_command *before, const vs_ref_command *now) {
  if (now->foul != before->foul) return false;
  if (stands_alone(now->foul)) return true;
  return now->team == before->team && now->quadrant == before->quadrant && now->half == before->half &&
         !(fabs(now->timestamp_s - before->timestamp_s) > 0);
}
