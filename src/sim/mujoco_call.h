// The one owner of MuJoCo's error and warning handlers.
#ifndef VSSS_SIM_MUJOCO_CALL_H
#define VSSS_SIM_MUJOCO_CALL_H

#include "vsss/status.h"

// Runs work(context). A fatal MuJoCo error inside it ends the work and becomes VS_FAIL with MuJoCo's message, instead of
// a line on the terminal and the end of the process. What work had allocated by then is lost: such an error is a defect.
// Warnings print nothing; they stay in mjData.warning, where vs_sim_frame looks.
vs_status vs_mujoco_call(void (*work)(void *context), void *context, vs_error *err);

#endif
