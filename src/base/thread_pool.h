/*
 * Threads that share the loops of one solver. Which thread works on which part of a loop is left to
 * chance. So a loop may be shared if no turn reads, or adds to, what another turn writes.
 */
#ifndef ILSAI_THREAD_POOL_H
#define ILSAI_THREAD_POOL_H

typedef struct thread_pool thread_pool;

/* Runs turns first .. end - 1 of a loop. It may not share a loop itself. */
typedef void pool_function(void *context, int first, int end);

/* Starts threads - 1 threads, which work beside the caller; threads >= 2. NULL on failure. */
thread_pool *ilsai_thread_pool_create(int threads);

/* Ends the threads and waits for them. *t may be NULL. */
void ilsai_thread_pool_destroy(thread_pool **t);

/*
 * Runs turns 0 .. count - 1 in parts of at least `least` turns, all of them on return. Without
 * a pool (NULL), and where the loop is too short for two parts, the caller runs it alone. One
 * caller at a time.
 */
void ilsai_thread_pool_run(thread_pool *t, pool_function *function, void *context, int count,
                           int least);

#endif
