#include "base/thread_pool.h"

#include "base/clock.h"
#include "base/memory.h"
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/* Parts of a loop per thread: uneven turns, and threads that come late, even out. */
#define POOL_PARTS 4
/*
 * Seconds that a thread looks for work before it goes to sleep. Longer than what a step does
 * between two loops: a core that idles, a virtual one above all, takes as long to wake up.
 */
#define POOL_AWAKE 1e-3
/* Looks at whether the others are done before the caller gives way to them. */
#define POOL_LOOKS 2000

#if defined(__x86_64__) || defined(__i386__)
#define pool_pause() __builtin_ia32_pause()
#elif defined(__aarch64__)
#define pool_pause() __asm__ volatile("yield")
#else
#define pool_pause() ((void)0)
#endif

struct thread_pool {
    /* the loop at work: written while nobody has a part of it, read by those who have */
    pool_function *function;
    void *context;
    int count, parts;

    atomic_uint_least64_t offer; /* parts first .. end - 1 are to be taken, see offer_of */
    atomic_int unfinished;       /* parts */

    pthread_mutex_t lock;
    pthread_cond_t news;
    atomic_int asleep; /* threads that wait for news */
    atomic_bool ending;
    int workers;
    pthread_t worker[];
};

/* The number of the loop goes in, so that nobody takes a part of one loop for that of another. */
static uint_least64_t offer_of(uint_least64_t loop, uint_least64_t first, uint_least64_t end) {
    return loop << 32 | end << 16 | first;
}

static int first_of(uint_least64_t offer) {
    return (int)(offer & 0xffff);
}

static int end_of(uint_least64_t offer) {
    return (int)(offer >> 16 & 0xffff);
}

/*
 * Takes a part, -1 if there is none. The caller takes the first one and the others the last: in
 * one loop after the other the same threads work on about the same turns.
 */
static int take(thread_pool *t, bool caller) {
    uint_least64_t offer = atomic_load(&t->offer), rest;
    do {
        if (first_of(offer) == end_of(offer)) {
            return -1;
        }
        rest = caller ? offer + 1 : offer - ((uint_least64_t)1 << 16);
    } while (!atomic_compare_exchange_weak(&t->offer, &offer, rest));
    return caller ? first_of(offer) : end_of(offer) - 1;
}

static int begin_of(const thread_pool *t, int part) {
    return (int)((int64_t)t->count * part / t->parts);
}

static void work(thread_pool *t, bool caller) {
    for (int part = take(t, caller); part >= 0; part = take(t, caller)) {
        t->function(t->context, begin_of(t, part), begin_of(t, part + 1));
        atomic_fetch_sub(&t->unfinished, 1);
    }
}

static bool has_news(thread_pool *t) {
    uint_least64_t offer = atomic_load(&t->offer);
    return first_of(offer) != end_of(offer) || atomic_load(&t->ending);
}

/* `asleep` is raised before the last look, and read after an offer: one of the two is seen. */
static void sleep_until_news(thread_pool *t) {
    pthread_mutex_lock(&t->lock);
    atomic_fetch_add(&t->asleep, 1);
    while (!has_news(t)) {
        pthread_cond_wait(&t->news, &t->lock);
    }
    atomic_fetch_sub(&t->asleep, 1);
    pthread_mutex_unlock(&t->lock);
}

static void wake(thread_pool *t) {
    if (atomic_load(&t->asleep) > 0) {
        pthread_mutex_lock(&t->lock);
        pthread_cond_broadcast(&t->news);
        pthread_mutex_unlock(&t->lock);
    }
}

static void *worker_main(void *argument) {
    thread_pool *t = argument;
    while (!atomic_load(&t->ending)) {
        work(t, false);
        for (double start = ilsai_clock(); !has_news(t) && ilsai_clock() - start < POOL_AWAKE;) {
            pool_pause();
        }
        if (!has_news(t)) {
            sleep_until_news(t);
        }
    }
    return NULL;
}

/* Signals are the host's: its own threads get them. False where a thread cannot be started. */
static bool start_workers(thread_pool *t, int count) {
    sigset_t all, own;
    bool failed = false;
    sigfillset(&all);
    if (pthread_sigmask(SIG_SETMASK, &all, &own)) {
        return false;
    }
    while (!failed && t->workers < count) {
        failed = pthread_create(&t->worker[t->workers], NULL, worker_main, t) != 0;
        t->workers += !failed;
    }
    pthread_sigmask(SIG_SETMASK, &own, NULL);
    return !failed;
}

thread_pool *ilsai_thread_pool_create(int threads) {
    size_t workers = (size_t)threads - 1;
    thread_pool *t = ilsai_allocate_zeroed(1, sizeof *t + workers * sizeof *t->worker);
    if (!t) {
        return NULL;
    }
    atomic_init(&t->offer, 0);
    atomic_init(&t->unfinished, 0);
    atomic_init(&t->asleep, 0);
    atomic_init(&t->ending, false);
    if (pthread_mutex_init(&t->lock, NULL)) {
        ilsai_release(t);
        return NULL;
    }
    if (pthread_cond_init(&t->news, NULL)) {
        pthread_mutex_destroy(&t->lock);
        ilsai_release(t);
        return NULL;
    }
    if (!start_workers(t, (int)workers)) {
        ilsai_thread_pool_destroy(&t);
    }
    return t;
}

void ilsai_thread_pool_destroy(thread_pool **t) {
    if (!*t) {
        return;
    }
    atomic_store(&(*t)->ending, true);
    wake(*t);
    for (int k = 0; k < (*t)->workers; k++) {
        pthread_join((*t)->worker[k], NULL);
    }
    pthread_cond_destroy(&(*t)->news);
    pthread_mutex_destroy(&(*t)->lock);
    ilsai_release(*t);
    *t = NULL;
}

/* Threads that still have a part are at work: they need no more than their turn on a core. */
static void wait_for_others(thread_pool *t) {
    for (int look = 0; atomic_load(&t->unfinished) > 0; look++) {
        if (look < POOL_LOOKS) {
            pool_pause();
        } else {
            sched_yield();
        }
    }
}

void ilsai_thread_pool_run(thread_pool *t, pool_function *function, void *context, int count,
                           int least) {
    int most = t ? POOL_PARTS * (t->workers + 1) : 1;
    int parts = t && count / least < most ? count / least : most;
    if (parts < 2) {
        function(context, 0, count);
        return;
    }
    t->function = function;
    t->context = context;
    t->count = count;
    t->parts = parts;
    atomic_store(&t->unfinished, parts);
    uint_least64_t loop = (atomic_load(&t->offer) >> 32) + 1;
    atomic_store(&t->offer, offer_of(loop, 0, (uint_least64_t)parts));
    wake(t);
    work(t, true);
    wait_for_others(t);
}
