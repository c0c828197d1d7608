#include "vsss/league_messages.h"

const char *vs_foul_name(vs_foul foul) {
  static const char *const name[VS_FOULS] = {"free kick", "penalty kick", "goal kick", "free ball",
                                             "kick-off",  "stop",         "game on",   "halt"};
  return foul >= 0 && foul < VS_FOULS ? name[foul] : "?";
}
