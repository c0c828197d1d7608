// src/cli/cmd_train.c and src/cli/cmd_plot.c, through the real binary
#include <stdbool.h>
#include <sys/stat.h>

#include "assert_near.h"
#include "interrupt_vsss.h"
#include "test_folder.h"

// A run that takes a moment: few matches, small networks.
#define SMALL "--threads 1 --set precision=fp32 --set envs=4 --set steps=16 --set minibatch=64 --set hidden=16,16 "

static vsss_run run;
static char text[65536];

static const char *with_folder(const char *format) {
  static char arguments[1024];
  snprintf(arguments, sizeof arguments, format, folder, folder, folder);
  return arguments;
}

static void train(const char *format) {
  vsss(&run, with_folder(format));
  if (run.status != 0) fail_msg("vsss %s: status %d: %s", with_folder(format), run.status, run.err);
}

static bool exists(const char *format) { return access(with_folder(format), F_OK) == 0; }

static const char *content(const char *format) {
  FILE *f = fopen(with_folder(format), "r");
  if (!f) fail_msg("%s was not written", with_folder(format));
  vsss_read_all(f, text, sizeof text);
  fclose(f);
  return text;
}

static int lines(const char *of) {
  int count = 0;
  for (; *of; of++) count += *of == '\n';
  return count;
}

// 4 matches, half of them with both sides learning: 18 rows x 16 steps = 288 transitions.
static void a_run_leaves_checkpoint_policy_tables_and_continues(void **state) {
  (void)state;
  train("train --run %s/a " SMALL "--transitions 0.001");
  assert_non_null(strstr(run.out, "done at 0.00 M transitions"));
  assert_int_equal(lines(content("%s/a/progress.csv")), 1 + 4); // 288 x 4 is the first above 1000
  assert_true(exists("%s/a/checkpoint") && exists("%s/a/policy.onnx"));
  assert_non_null(strstr(content("%s/a/settings.ini"), "hidden = 16,16"));
  train("train --resume %s/a --transitions 0.002");
  assert_int_equal(lines(content("%s/a/progress.csv")), 1 + 7); // 288 x 7 is the first above 2000
  assert_true(exists("%s/a/checkpoint.previous"));
  train("plot %s/a --svg");
  assert_true(exists("%s/a/reward.svg"));
  assert_non_null(strstr(content("%s/a/reward.svg"), "<svg"));
  train("sim --blue onnx:%s/a/policy.onnx --yellow zero: --seconds 2 --drive planar");
  assert_refused(with_folder("train --run %s/a " SMALL), 2, "holds a run: continue it with --resume");
}

// The last line of a run's progress from the reward on: all that no clock goes into.
static const char *outcome(const char *format) {
  content(format);
  char *end = strrchr(text, ',');
  for (int column = 0; column < 22; column++) {
    while (*--end != ',') {
    }
  }
  return end;
}

static void assert_same_outcome(const char *run_a, const char *run_b) {
  static char first[65536];
  snprintf(first, sizeof first, "%s", outcome(run_a));
  assert_string_equal(first, outcome(run_b));
}

static void two_runs_of_one_seed_are_the_same(void **state) {
  (void)state;
  train("train --run %s/s1 " SMALL "--transitions 0.001 --seed 7");
  train("train --run %s/s2 " SMALL "--transitions 0.001 --seed 7 --threads 2");
  assert_same_outcome("%s/s1/progress.csv", "%s/s2/progress.csv");
}

// 288 transitions an update: the new run's first line is the fifth update.
static void a_small_checkpoint_begins_a_new_run(void **state) {
  (void)state;
  train("train --run %s/b " SMALL "--transitions 0.001 --slim %s/small");
  assert_refused(with_folder("train --run %s/b --resume %s/small"), 2, "holds a run");
  train("train --run %s/n --resume %s/small --transitions 0.0015");
  assert_non_null(strstr(content("%s/n/progress.csv"), "\n5,1440,"));
  assert_int_equal(lines(content("%s/b/progress.csv")), 1 + 4); // the old one is as it was
}

// The mean of two ages is another start than the later one.
static void a_run_begins_with_the_mean_of_checkpoints(void **state) {
  (void)state;
  train("train --run %s/old " SMALL "--transitions 0.001 --slim %s/grown --keep-every-m 0.0004");
  assert_true(exists("%s/old/kept/0000000576.checkpoint") && exists("%s/old/kept/0000000864.checkpoint"));
  train("train --run %s/w1 --resume %s/grown --transitions 0.0015");
  char alone[4096], average[512];
  snprintf(alone, sizeof alone, "%s", outcome("%s/w1/progress.csv"));
  snprintf(average, sizeof average,
           "train --run %s/w2 --resume %s/grown --average %s/old/kept/0000000576.checkpoint --transitions 0.0015",
           folder, folder, folder);
  vsss(&run, average);
  assert_int_equal(run.status, 0);
  assert_true(strcmp(alone, outcome("%s/w2/progress.csv")) != 0);
  assert_refused(with_folder("train --resume %s/old --average %s/grown"), 2, "--average begins a new run");
}

// Every kind of player: what it remembers is part of the checkpoint.
static void a_run_against_any_player_continues(void **state) {
  (void)state;
  static const char *const players[] = {"emc:",
                                        "emc:?pid=1",
                                        "inf:",
                                        "emc22:",
                                        "random:",
                                        "zero:",
                                        "onnx:build/untrained.onnx",
                                        "self=0.5,emc:=0.3,frozen=0.2"};
  for (size_t i = 0; i < sizeof players / sizeof *players; i++) {
    char format[512];
    snprintf(format, sizeof format, "rm -rf '%s/o'", folder);
    assert_int_equal(system(format), 0);
    snprintf(format, sizeof format, "train --run %%s/o " SMALL "--transitions 0.0003 --opponent '%s'", players[i]);
    train(format);
    train("train --resume %s/o --transitions 0.0006");
    assert_int_equal(run.err[0], '\0');
  }
}

// The settings of a run are a file: what begins a comment there must come back, and so must any seed.
static void any_file_name_and_any_seed_survive_a_resume(void **state) {
  (void)state;
  static const char *const names[] = {"#r.ini",    "a;b.ini",     "with space.ini",
                                      " edge.ini", "quote\".ini", "back\\slash.ini"};
  static const char *const written[] = {"#r.ini\"",    "a;b.ini\"",       "with space.ini\n",
                                        " edge.ini\n", "quote\\\".ini\"", "back\\\\slash.ini\""};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    char path[256], format[512];
    snprintf(path, sizeof path, "%s/%s", folder, names[i]);
    FILE *f = fopen(path, "w");
    fprintf(f, "[latency_s]\nlow = 0.05\nhigh = 0.06\n");
    fclose(f);
    snprintf(format, sizeof format, "rm -rf '%s/q'", folder);
    assert_int_equal(system(format), 0);
    snprintf(format, sizeof format, "train --run %%s/q " SMALL "--transitions 0.0003 --seed %s --realism '%s'",
             i % 2 ? "18446744073709551615" : "2100000000", path);
    train(format);
    train("train --resume %s/q --transitions 0.0006");
    assert_non_null(strstr(content("%s/q/settings.ini"), written[i]));
    assert_non_null(strstr(text, i % 2 ? "seed = 18446744073709551615\n" : "seed = 2100000000\n"));
    assert_non_null(strstr(text, "# matches side by side; 1 to 4096\nenvs = 4\n"));
    unlink(path); // the run reads it again, so it is not forgotten
    assert_refused(with_folder("train --resume %s/q --transitions 0.0009"), 1, "No such file");
  }
}

// As the README's command does with the checkpoint that comes with vsss.
static void a_checkpoint_that_is_done_trains_on_and_says_how_far(void **state) {
  (void)state;
  char binary[4096], next[4400];
  train("train --run %s/f " SMALL "--transitions 0.0003 --slim %s/done");
  assert_non_null(strstr(run.out, "/f --transitions 0.0006"));
  vsss_binary(binary, sizeof binary); // as this program was called
  snprintf(next, sizeof next, "  %s eval --blue onnx:%s/f/policy.onnx", binary, folder);
  assert_non_null(strstr(run.out, next));
  train("train --run %s/g --resume %s/done --minutes 0.0001");
  assert_non_null(strstr(run.out, "has reached its limit of 0.0003 M transitions: going on to 60.0006 M"));
  assert_non_null(strstr(run.out, "stopped at"));
  assert_int_equal(lines(content("%s/g/progress.csv")), 1 + 1);
  // A limit that was given is kept.
  train("train --run %s/l --resume %s/done --transitions 0.0001");
  assert_non_null(strstr(run.out, "done at"));
  assert_int_equal(lines(content("%s/l/progress.csv")), 1);
}

static void interrupting_a_run_saves_it(void **state) {
  (void)state;
  vsss_interrupt(&run, with_folder("train --run %s/i " SMALL), "training in");
  assert_int_equal(run.status, 0);
  assert_non_null(strstr(run.out, "stopped at"));
  assert_true(exists("%s/i/checkpoint"));
}

static void evaluation_is_written_beside_the_progress(void **state) {
  (void)state;
  train("train --run %s/e " SMALL "--transitions 0.0005 --eval-every 0.000001 --eval-against zero: --eval-matches 1");
  assert_true(lines(content("%s/e/eval.csv")) >= 2);
  assert_non_null(strstr(text, ",zero:,1,"));
  train("plot %s/e");
  assert_true(exists("%s/e/eval_score.png"));
}

static void matches_of_several_runs_are_drawn_side_by_side(void **state) {
  (void)state;
  train("train --run %s/side-a " SMALL
        "--transitions 0.0005 --eval-every 0.000001 --eval-against zero: --eval-matches 1");
  assert_refused(with_folder("plot %s/side-a %s/side-b --compare %s/side"), 1, "side-b/eval.csv");
  assert_false(exists("%s/side"));
  assert_int_equal(system(with_folder("cp -r %s/side-a %s/side-b")), 0);
  train("plot %s/side-a %s/side-b --compare %s/side/by --svg");
  assert_non_null(strstr(run.out, "side/by/compare_win.svg\n"));
  const char *const figures[] = {"%s/side/by/compare_win.svg", "%s/side/by/compare_score.svg"};
  for (int i = 0; i < 2; i++) {
    const char *figure = content(figures[i]);
    assert_non_null(strstr(figure, "side-a"));
    assert_non_null(strstr(figure, "side-b"));
    assert_non_null(strstr(figure, "zero:"));
    assert_non_null(strstr(figure, "million transitions"));
  }
  train("plot %s/side-a --compare %s/side --minutes --svg");
  assert_non_null(strstr(content("%s/side/compare_win.svg"), "minutes of training"));
  assert_int_equal(system(with_folder("echo 1,2 >> %s/side-b/eval.csv")), 0);
  assert_refused(with_folder("plot %s/side-a %s/side-b --compare %s/side"), 1, "not a row of transitions");
  assert_refused(with_folder("plot %s/side-a --minutes"), 2, "--compare");
}

static void evaluation_after_so_many_transitions_on_the_drive_that_is_named(void **state) {
  (void)state;
  train("train --run %s/t " SMALL
        "--transitions 0.0025 --eval-every-m 0.0009 --eval-against zero: --eval-matches 1 --eval-drive planar");
  assert_int_equal(lines(content("%s/t/eval.csv")), 1 + 2); // after 4 and 8 updates of 288
  assert_refused(with_folder("train --run %s/u " SMALL "--transitions 0.001 --eval-drive flat"), 2, "flat");
}

static void a_script_is_imitated_before_the_run(void **state) {
  (void)state;
  train("train --run %s/m " SMALL "--transitions 0.0003 --imitate zero: --imitate-updates 3 --opponent emc:");
  assert_non_null(strstr(run.out, "imitating zero:"));
}

static void a_damaged_checkpoint_is_named_and_the_one_before_continues(void **state) {
  (void)state;
  train("train --run %s/d " SMALL "--transitions 0.0003");
  train("train --resume %s/d --transitions 0.0006");
  assert_int_equal(truncate(with_folder("%s/d/checkpoint"), 1000), 0);
  train("train --resume %s/d --transitions 0.0012");
  assert_non_null(strstr(run.out, "d/checkpoint: truncated or damaged"));
  assert_int_equal(truncate(with_folder("%s/d/checkpoint"), 0), 0);
  assert_int_equal(truncate(with_folder("%s/d/checkpoint.previous"), 10), 0);
  assert_refused(with_folder("train --resume %s/d"), 1, "d/checkpoint: not a checkpoint");
}

static void wrong_settings_are_refused_with_the_allowed_range(void **state) {
  (void)state;
  assert_refused("train --preset fast", 2, "expected default or paper");
  assert_refused("train --set gamma=1.5", 2, "allowed are 0.5 to 0.99999");
  assert_refused("train --set clip=0", 2, "allowed are 0.01 to 1");
  assert_refused("train --set epochs=0", 2, "allowed are 1 to 100");
  assert_refused("train --set learning_rate=nan", 2, "expected a number");
  assert_refused("train --set learnig_rate=1e-3", 2, "did you mean 'learning_rate'");
  assert_refused("train --set hidden=256,0", 2, "1 to 4 sizes of 1 to 4096");
  assert_refused("train --set minibatch=1000000", 2, "minibatch = 1000000");
  assert_refused("train --set drive=hover", 2, "hover");
  assert_refused("train --set reward=glory", 2, "expected paper, dense or goals");
  assert_refused("train --set reward=dense,fame=1", 2, "own_distance");
  assert_refused("train --opponent nobody", 2, "opponent 'nobody'");
  assert_refused("train --learner brain", 2, "own or torch");
  assert_refused("train --set canonical=true --set export_average=true", 2, "exclude each other");
  assert_refused("train --set still_low_s=9 --set still_high_s=3", 2, "must not be below still_low_s");
  assert_refused("train --set start_open=0.8 --set start_penalty=0.3", 2, "at most 1");
  assert_refused("train --set precision=fp16", 2, "expected fp32, bf16 or auto");
  assert_refused("train --set precision=bf16 --learner torch", 2, "torch computes in fp32");
  assert_refused("train --resume /nowhere", 1, "/nowhere/checkpoint");
  assert_refused("train --run /proc/none", 1, "/proc/none");
  assert_refused("plot", 2, "name a run's folder");
  assert_refused("plot /nowhere", 1, "/nowhere/progress.csv");
}

// The banner says what multiplies. Told to do without bf16, oneDNN 2.6 refuses such products, which must be noticed; 3.7
// computes them by other means.
static void the_precision_is_what_was_set_or_what_the_machine_has(void **state) {
  (void)state;
  train("train --run %s/fp32 " SMALL "--transitions 0.0001 --set precision=fp32");
  assert_non_null(strstr(run.out, "gradients in fp32"));
  assert_non_null(strstr(content("%s/fp32/settings.ini"), "precision = fp32"));
  setenv("ONEDNN_MAX_CPU_ISA", "AVX2", 1);
  train("train --run %s/auto " SMALL "--transitions 0.0001 --set precision=auto");
  if (!strstr(run.out, "gradients in bf16")) {
    assert_non_null(strstr(run.out, "gradients in fp32"));
    assert_refused(with_folder("train --run %s/bf16 " SMALL "--set precision=bf16"), 1, "--set precision=fp32");
  }
  unsetenv("ONEDNN_MAX_CPU_ISA");
  // What was chosen is the run's setting from then on.
  bool bf16 = strstr(run.out, "gradients in bf16") != NULL;
  assert_non_null(strstr(content("%s/auto/settings.ini"), bf16 ? "precision = bf16" : "precision = fp32"));
}

// Two processes: as root, Open MPI wants two variables.
static bool ranks_can_be_started(void) {
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  setenv("LSAN_OPTIONS", "detect_leaks=0", 1); // Open MPI's own
  if (system("command -v mpirun >/dev/null") == 0 && access("build/lib/vsss_mpi.so", F_OK) == 0) return true;
  print_message("note: no mpirun, or a build without MPI\n");
  skip();
  return false;
}

// command: what starts the binary twice.
static int train_ranks(const char *command, const char *run_name) {
  char binary[4096], line[8192];
  vsss_binary(binary, sizeof binary);
  snprintf(line, sizeof line, "%s '%s' train --run %s/%s " SMALL "--transitions 0.001 </dev/null >%s/%s.out 2>&1",
           command, binary, folder, run_name, folder, run_name);
  int status = system(line);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

static void two_ranks_train_together_and_a_dead_one_ends_the_run(void **state) {
  (void)state;
  char binary[4096], command[8192];
  if (!ranks_can_be_started()) return;
  if (train_ranks("timeout 120 mpirun --oversubscribe -n 2", "p") != 0) fail_msg("%s", content("%s/p.out"));
  assert_non_null(strstr(content("%s/p.out"), "2 ranks, each:"));
  assert_int_equal(lines(content("%s/p/progress.csv")), 1 + 2); // 2 x 288 an update
  // Rank 1 is killed: mpirun ends, and what rank 0 saved last is whole.
  vsss_binary(binary, sizeof binary);
  snprintf(
      command, sizeof command,
      "cp -r %s/p %s/k; timeout 120 mpirun --oversubscribe -n 2 sh -c '[ $OMPI_COMM_WORLD_RANK = 0 ] || (sleep 4; kill "
      "-9 $$) & exec %s train --resume %s/k --transitions 1000 --checkpoint-every 0.001' </dev/null >%s/k.out 2>&1",
      folder, folder, binary, folder, folder);
  assert_int_not_equal(system(command), 0);
  train("train --resume %s/k --transitions 0.001");
  assert_null(strstr(run.out, "damaged"));
}

static void two_hosts_train_as_two_ranks_on_one_do(void **state) {
  (void)state;
  if (!ranks_can_be_started() || !exists("%s/p/progress.csv")) return;
  int status = train_ranks("sh tests/cli/two_hosts.sh", "h");
  if (status == 77) {
    print_message("note: %s", content("%s/h.out"));
    skip();
  }
  if (status != 0) fail_msg("status %d: %s", status, content("%s/h.out"));
  assert_same_outcome("%s/p/progress.csv", "%s/h/progress.csv");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_run_leaves_checkpoint_policy_tables_and_continues),
      cmocka_unit_test(two_runs_of_one_seed_are_the_same),
      cmocka_unit_test(a_small_checkpoint_begins_a_new_run),
      cmocka_unit_test(a_run_begins_with_the_mean_of_checkpoints),
      cmocka_unit_test(a_run_against_any_player_continues),
      cmocka_unit_test(any_file_name_and_any_seed_survive_a_resume),
      cmocka_unit_test(a_checkpoint_that_is_done_trains_on_and_says_how_far),
      cmocka_unit_test(interrupting_a_run_saves_it),
      cmocka_unit_test(evaluation_is_written_beside_the_progress),
      cmocka_unit_test(matches_of_several_runs_are_drawn_side_by_side),
      cmocka_unit_test(evaluation_after_so_many_transitions_on_the_drive_that_is_named),
      cmocka_unit_test(a_script_is_imitated_before_the_run),
      cmocka_unit_test(a_damaged_checkpoint_is_named_and_the_one_before_continues),
      cmocka_unit_test(wrong_settings_are_refused_with_the_allowed_range),
      cmocka_unit_test(the_precision_is_what_was_set_or_what_the_machine_has),
      cmocka_unit_test(two_ranks_train_together_and_a_dead_one_ends_the_run),
      cmocka_unit_test(two_hosts_train_as_two_ranks_on_one_do),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
