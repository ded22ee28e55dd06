/* recovery.h: what is being edited, kept in a file from time to time, so that a crash costs seconds of work.
 *
 * Each window has a file of its own, NAME.json, and beside it NAME.lock, on which its process has a lock (flock) for as
 * long as it runs: a file whose lock is to be had is left over from a process that is gone, and whoever takes the lock
 * owns it. */
#ifndef TC_EDIT_RECOVERY_H
#define TC_EDIT_RECOVERY_H

#include "tetcast.h"

#include <time.h>

typedef struct tc_recovery tc_recovery;

/* The folder of these files: $XDG_STATE_HOME/tetcast, else ~/.local/state/tetcast; from malloc. NULL: there is no home,
 * or memory ran out. */
char *tc_recovery_folder(void);

/* A new one in the folder, which is made (for its owner alone) if it is not there. Nothing is written yet but the lock.
 * Errors: TC_E_FILE, TC_E_MEMORY; *out is NULL then. */
tc_status tc_recovery_open(tc_recovery **out, const char *folder, tc_error *err);
/* The newest that a process left which is gone, now of this one. *out NULL: there is none, which is no error (a folder
 * that is not there neither). Locks without a file are removed. Errors: TC_E_MEMORY. */
tc_status tc_recovery_claim(tc_recovery **out, const char *folder, tc_error *err);

/* Writes the text in place of what was there, whole or not at all. Errors: TC_E_FILE, TC_E_MEMORY; what was there
 * stays. */
tc_status tc_recovery_save(tc_recovery *recovery, const char *text, tc_error *err);
/* Its file, and when that was written (0: not yet). */
const char *tc_recovery_path(const tc_recovery *recovery);
time_t tc_recovery_time(const tc_recovery *recovery);
/* keep: its file stays, for another start to be offered; else all of it is removed. *recovery is freed. */
void tc_recovery_close(tc_recovery **recovery, bool keep);

#endif
