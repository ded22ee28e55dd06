/* stop.h: SIGINT and SIGTERM ask a batch to stop once the frame at hand is finished; a second one ends it at once. */
#ifndef TC_CLI_BATCH_STOP_H
#define TC_CLI_BATCH_STOP_H

/* Before any helper program is started: those signals stay away from helpers, and still end this program at once. */
void tc_stop_prepare(void);
/* From now on they ask. */
void tc_stop_listen(void);
/* The name of the signal that asked, "SIGINT"; NULL: none did. */
const char *tc_stop_asked(void);

#endif
