// Signals and computing threads. Kernels of oneDNN keep data below the stack pointer, where the kernel of the operating
// system puts the frame of a signal's handler: a signal that arrives during a product damages memory. So none may.
#ifndef VSSS_SIGNALS_H
#define VSSS_SIGNALS_H

#ifdef __cplusplus
extern "C" {
#endif

// Between the two this thread takes no signals but those of its own faults (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT,
// SIGTRAP, SIGSYS); others wait, or go to another thread. They nest, and cost two system calls where they do not. A
// thread that was started in between inherits the mask.
void vs_signals_hold(void);
void vs_signals_release(void);

#ifdef __cplusplus
}
#endif
#endif
