// The commands: int cmd_NAME(int argc, char **argv), argv[0] is the command's name. Returns the exit status.
#ifndef VSSS_CLI_COMMANDS_H
#define VSSS_CLI_COMMANDS_H

int cmd_calibrate(int argc, char **argv);
int cmd_detect(int argc, char **argv);
int cmd_field(int argc, char **argv);
int cmd_rig(int argc, char **argv);
int cmd_train(int argc, char **argv);
int cmd_sim(int argc, char **argv);
int cmd_eval(int argc, char **argv);
int cmd_plot(int argc, char **argv);

int cmd_bridge(int argc, char **argv);
int cmd_doctor(int argc, char **argv);
int cmd_identify(int argc, char **argv);
int cmd_latency(int argc, char **argv);
int cmd_replay(int argc, char **argv);
int cmd_league(int argc, char **argv);
int cmd_view(int argc, char **argv);
int cmd_serve(int argc, char **argv);
int cmd_spy(int argc, char **argv);

#endif
