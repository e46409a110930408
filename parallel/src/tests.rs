//! The same lines compile, and give the same, with threads and without: `./check` runs them both ways.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::prelude::*;

/// While one test looks at the threads of the pool, no other has work done in it.
fn pool() -> MutexGuard<'static, ()> {
    static POOL: Mutex<()> = Mutex::new(());
    POOL.lock().unwrap_or_else(PoisonError::into_inner)
}

#[test]
fn iterators_keep_the_order_of_elements() {
    let numbers: Vec<u32> = (0..1000).collect();
    let doubled: Vec<u32> = numbers.par_iter().with_min_len(16).with_max_len(64).map(|n| 2 * n).collect();
    assert!(doubled.iter().zip(&numbers).all(|(double, n)| *double == 2 * n));
    let pairs: Vec<u32> = (0..1000_u32).into_par_iter().flat_map_iter(|n| [n, n]).collect();
    assert_eq!(pairs.len(), 2 * numbers.len());
    assert!(pairs.chunks_exact(2).zip(&numbers).all(|(pair, n)| pair == [*n; 2]));
    let flat: Vec<u32> = vec![vec![1, 2], vec![], vec![3]].into_par_iter().flatten_iter().collect();
    assert_eq!(flat, [1, 2, 3]);
    let sums: Vec<u32> = numbers.par_chunks(300).map(|chunk| chunk.iter().sum()).collect();
    assert_eq!(sums.len(), 4);
    assert_eq!(sums.iter().sum::<u32>(), 999 * 500);
    assert_eq!(numbers.par_chunks_exact(300).map(<[u32]>::len).collect::<Vec<_>>(), [300; 3]);
    assert!(numbers.par_windows(2).all(|pair| pair[0] + 1 == pair[1]));
}

#[test]
fn parts_of_any_length_are_all_elements_in_order() {
    for (length, least, most) in
        [(0, 1, 1), (1, 5, 3), (2, 1, 1), (999, 7, 20), (1000, 1000, 1), (4096, 0, 0), (5000, 64, 100)]
    {
        let numbers: Vec<usize> = (0..length).collect();
        let all = || numbers.par_iter().zip(&numbers).enumerate().with_min_len(least).with_max_len(most);
        let made: Vec<usize> = all().map(|(place, (one, other))| place + one + other).collect();
        assert!(made.into_iter().eq(numbers.iter().map(|n| 3 * n)), "{length} {least} {most}");
        // these are not as many as there are elements
        let some: Vec<usize> = all().filter(|(place, _)| place % 3 == 0).map(|(place, _)| place).collect();
        assert!(some.into_iter().eq(numbers.iter().copied().step_by(3)), "{length} {least} {most}");
        // and these may end early
        let last = length.checked_sub(1);
        assert_eq!(all().any(|(place, _)| Some(place) == last), length > 0, "{length} {least} {most}");
        assert!(all().all(|(place, _)| place < length), "{length} {least} {most}");
    }
}

#[test]
fn a_loop_within_a_loop_and_one_that_panics() {
    let of_row = |row: u32| (0..row).into_par_iter().map(|k| k).collect::<Vec<u32>>().len();
    let lengths: Vec<usize> = (0..200).into_par_iter().map(of_row).collect();
    assert!(lengths.into_iter().eq(0..200));
    let outcome = std::panic::catch_unwind(|| (0..1000).into_par_iter().for_each(|k| assert!(k != 600, "this one")));
    assert_eq!(outcome.unwrap_err().downcast_ref(), Some(&"this one"));
}

#[test]
fn states_are_scratch_memory() {
    let lengths: Vec<usize> = (0..100_usize)
        .into_par_iter()
        .map_init(Vec::new, |scratch, n| {
            scratch.clear();
            scratch.extend(0..n);
            scratch.len()
        })
        .collect();
    assert_eq!(lengths, (0..100).collect::<Vec<_>>());
    let mut written = vec![0; 100];
    written.par_iter_mut().enumerate().for_each_init(Vec::new, |scratch, (n, place)| {
        scratch.clear();
        scratch.extend(0..n);
        *place = scratch.len();
    });
    assert_eq!(written, lengths);
}

#[test]
fn lists_grow_by_all_elements_in_order() {
    let mut numbers = vec![7, 8];
    numbers.par_extend((0..1000).into_par_iter().with_min_len(10).map(|n| 3 * n));
    assert!(numbers.into_iter().eq([7, 8].into_iter().chain((0..1000).map(|n| 3 * n))));
}

#[test]
fn parts_keep_their_order() {
    for count in [0, 1, 2, 1000] {
        let results = crate::map_parts(count, |part| {
            // some take longer than others
            (0..part % 7 * 100).fold(part, |sum, k| sum ^ k ^ k)
        });
        assert!(results.into_iter().eq(0..count));
    }
    // also within each other
    let sums = crate::map_parts(40, |part| crate::map_parts(part, |k| k).into_iter().sum::<usize>());
    assert!(sums.into_iter().enumerate().all(|(part, sum)| sum == part * part.saturating_sub(1) / 2));
}

#[test]
fn work_in_the_pool_is_watched_as_its_caller() {
    use crate::job::{Stopped, Watch, check, progress, watched};

    let _pool = pool();
    let watch = Watch::new();
    let sum = watched(&watch, || {
        crate::in_pool(|| {
            progress(3, 7);
            crate::in_pool(|| crate::map_parts(10, |k| k).into_iter().sum::<usize>())
        })
    });
    assert_eq!((sum, watch.progress()), (45, (3, 7)));
    watch.stop();
    let ended = std::panic::catch_unwind(|| watched(&watch, || crate::in_pool(check)));
    assert!(ended.unwrap_err().is::<Stopped>());
    crate::in_pool(check);
}

#[cfg(all(feature = "threads", target_os = "linux"))]
#[test]
fn threads_of_a_pool_that_slept_may_run_where_they_might_before() {
    use std::time::{Duration, Instant};

    let _pool = pool();
    let allowed = || rayon::broadcast(|_| rustix::thread::sched_getaffinity(None).expect("what a thread may run on"));
    let before = allowed();
    std::thread::sleep(Duration::from_millis(30));
    assert_eq!(crate::in_pool(|| crate::map_parts(100, |part| part).len()), 100);
    assert_eq!(allowed(), before);
    // longer than they are kept where they are put
    std::thread::sleep(Duration::from_millis(30));
    let moves = crate::in_pool(|| {
        let begin = Instant::now();
        while begin.elapsed() < Duration::from_millis(80) {}
        allowed()
    });
    assert_eq!(moves, before);
    std::thread::sleep(Duration::from_millis(30));
    let outcome = std::panic::catch_unwind(|| crate::in_pool(|| panic!("this one")));
    assert_eq!(outcome.unwrap_err().downcast_ref(), Some(&"this one"));
    assert_eq!(allowed(), before);
}

#[cfg(feature = "threads")]
#[test]
fn threads_that_stay_awake_do_the_work_of_others_until_it_is_over_or_there_is_none() {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use crate::awake::look_for_work;

    // of one thread, so that no other one takes the work
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool of threads");
    pool.install(|| {
        let done = AtomicUsize::new(0);
        rayon::scope(|scope| {
            for _ in 0..3 {
                scope.spawn(|_| {
                    done.fetch_add(1, Ordering::Relaxed);
                });
            }
            look_for_work(&AtomicUsize::new(0));
            assert_eq!(done.load(Ordering::Relaxed), 0);
            look_for_work(&AtomicUsize::new(1));
            assert_eq!(done.load(Ordering::Relaxed), 3);
        });
    });
}

/// A thread that looks for work finds that it is to look for that of another caller, too, again and again while callers overlap.
#[cfg(feature = "threads")]
#[test]
fn works_that_overlap_do_not_fill_the_stack_of_a_thread() {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use crate::awake::look_for_work;

    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool of threads");
    pool.install(|| {
        let (works, done) = (AtomicUsize::new(1), AtomicUsize::new(0));
        rayon::scope(|scope| {
            // the last one is found first; looked for within each other, the first would be found before any of the others ends
            for number in 0..100 {
                let (works, done) = (&works, &done);
                scope.spawn(move |_| {
                    look_for_work(works);
                    assert_eq!(done.fetch_add(1, Ordering::Relaxed), 99 - number);
                });
            }
            look_for_work(&works);
        });
        assert_eq!(done.into_inner(), 100);
    });
}

#[cfg(feature = "threads")]
#[test]
fn threads_stay_awake_where_there_are_processors_for_them_and_not_only_for_the_one_that_is_asked() {
    let _pool = pool();
    // the first caller asks, and then threads may be kept on processors of their own
    assert_eq!(crate::in_pool(|| crate::map_parts(10, |part| part).len()), 10);
    let (threads, processors) = (rayon::current_num_threads(), std::thread::available_parallelism());
    let are_enough = (2..=16.min(processors.expect("a number of processors").get())).contains(&threads);
    assert_eq!(crate::awake::is_worthwhile(), are_enough);
}

#[test]
fn callers_of_the_pool_at_once_do_not_wait_for_one_another_for_ever() {
    let _pool = pool();
    std::thread::scope(|scope| {
        for caller in 0..6_usize {
            scope.spawn(move || {
                for round in 0..40 {
                    let sum = crate::in_pool(|| {
                        let sums = crate::map_parts(20, |part| crate::map_parts(part, |k| k * caller + round));
                        sums.into_iter().flatten().sum::<usize>()
                    });
                    let expected: usize = (0..20).flat_map(|part| 0..part).map(|k| k * caller + round).sum();
                    assert_eq!(sum, expected, "caller {caller}, round {round}");
                }
            });
        }
    });
}

#[test]
fn a_part_that_panics_ends_the_work() {
    let outcome = std::panic::catch_unwind(|| crate::map_parts(100, |part| assert!(part != 60, "this one")));
    assert_eq!(outcome.unwrap_err().downcast_ref(), Some(&"this one"));
}

#[test]
fn slices_are_sorted_and_split() {
    let mut numbers: Vec<u32> = (0..1000).map(|n| n * 7 % 1000).collect();
    numbers.par_sort_unstable();
    assert!(numbers.iter().copied().eq(0..1000));
    numbers.par_sort_unstable_by(|a, b| b.cmp(a));
    assert!(numbers.iter().copied().eq((0..1000).rev()));
    numbers.par_chunk_by_mut(|a, b| a / 100 == b / 100).for_each(|run| run.reverse());
    numbers.par_chunks_mut(100).for_each(|chunk| chunk.reverse());
    assert!(numbers.iter().copied().eq((0..1000).rev()));
    assert_eq!(crate::join(|| 1, || "two"), (1, "two"));
    assert!(crate::current_num_threads() >= 1);
}

#[test]
fn what_is_dropped_beside_work_is_gone_after_it() {
    let _alone = pool();
    let look = || {
        let dropped = Arc::new(());
        let known = Arc::downgrade(&dropped);
        assert_eq!(crate::drop_beside(dropped, || 7), 7);
        assert!(known.upgrade().is_none());
    };
    look();
    crate::in_pool(look);
}

/// Whoever waits for the other thread without falling asleep sees that it has ended.
#[test]
#[cfg(panic = "unwind")]
fn a_panic_of_either_thread_ends_a_join_and_a_loop() {
    let _alone = pool();
    let ends = |work: fn(usize)| {
        let join = || crate::in_pool(|| crate::join(|| work(0), || work(1)));
        assert!(std::panic::catch_unwind(join).is_err());
        let every = || crate::in_pool(|| (0..64_usize).into_par_iter().with_max_len(1).for_each(work));
        assert!(std::panic::catch_unwind(every).is_err());
        let parts = || crate::in_pool(|| crate::map_parts(64, work));
        assert!(std::panic::catch_unwind(parts).is_err());
    };
    for _ in 0..10 {
        ends(|number| {
            if number % 64 == 0 {
                std::panic::resume_unwind(Box::new(number))
            }
        });
        ends(|number| {
            if number % 64 == 1 {
                std::panic::resume_unwind(Box::new(number))
            }
        });
    }
}

#[test]
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn freed_memory_is_kept() {
    // pages of the process that are in memory
    let resident = || {
        let statm = std::fs::read_to_string("/proc/self/statm").expect("Linux tells what memory a process has");
        statm.split(' ').nth(1).and_then(|pages| pages.parse::<usize>().ok()).expect("a number of pages")
    };
    crate::keep_freed_memory();
    let (block, before) = (std::hint::black_box(vec![1_u8; 24 << 20]), resident());
    drop(block);
    // of its 6,144 pages
    assert!(resident() + 1500 > before, "{} of {before} pages are left", resident());
    assert!(crate::maps_long_lists());
    crate::spare_addresses();
    assert!(!crate::maps_long_lists());
}
