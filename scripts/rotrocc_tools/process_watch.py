"""Watches memory and threads of a process until SIGINT, and prints a summary, or that of stored samples:
process_watch.py PID SAMPLES.csv, or process_watch.py SAMPLES.csv, for scripts/soak.

Memory is that of the process alone, without the files it has mapped. What leaks raises both its maxima and its
minima: its growth is the smaller of their slopes over the quarters of a run. Maxima alone rise with the load of the
machine, minima alone if less of what is freed goes back to the system. Memory mostly stands still, and changes by
some megabytes when a fault needs another buffer or frees one, every few minutes: shorter parts may have only one of both.

The exit status is 1 if there are more threads in the second half than in the first or, in runs longer than
ten minutes, if memory grows by 1 MB per hour or more after the first five.
"""
import signal
import statistics
import sys
import time

import numpy
import psutil

PERIOD_S = 1.0
SETTLE_S = 300.0
LEAST_LENGTH_S = 600.0
PARTS = 4
MAX_SLOPE_MB_PER_H = 1.0


def watch(pid):
    """Samples (time [s], memory [MB], threads, CPU time [s]) until SIGINT or the end of the process."""
    samples = []
    start = time.monotonic()
    try:
        process = psutil.Process(pid)
        while True:
            with process.oneshot():
                times, memory = process.cpu_times(), process.memory_info()
                samples.append((time.monotonic() - start, (memory.rss - memory.shared) / 2**20,
                                process.num_threads(), times.user + times.system))
            time.sleep(PERIOD_S)
    except (KeyboardInterrupt, psutil.NoSuchProcess):
        return samples


def growth_of(samples):
    """Growth of the memory [MB/h]."""
    parts = [part[:, :2] for part in numpy.array_split(numpy.array(samples), PARTS)]
    middles_s = [part[:, 0].mean() for part in parts]
    return min(3600.0 * numpy.polyfit(middles_s, [extreme(part[:, 1]) for part in parts], 1)[0]
               for extreme in (numpy.min, numpy.max))


def main(*arguments):
    if len(arguments) == 1:
        samples = numpy.loadtxt(arguments[0], delimiter=',', skiprows=1, ndmin=2).tolist()
    else:
        signal.signal(signal.SIGINT, signal.default_int_handler)  # in the background it is ignored
        samples = watch(int(arguments[0]))
        numpy.savetxt(arguments[1], samples, '%.3f', ',', header='time_s,memory_mb,threads,cpu_s', comments='')
    if len(samples) < 10:
        print("the process was there for too short a time to say anything")
        return 1
    length_s = samples[-1][0]
    is_long = length_s >= LEAST_LENGTH_S
    settled = [s for s in samples if s[0] >= (SETTLE_S if is_long else length_s / 3)]
    slope = growth_of(settled)
    middle = len(settled) // 2
    # A thread that is there for a moment does not count.
    threads_before = statistics.median_high(s[2] for s in settled[:middle])
    threads_after = statistics.median_high(s[2] for s in settled[middle:])
    print(f"memory                     {settled[0][1]:.1f} MB at {settled[0][0]:.0f} s, "
          f"{settled[-1][1]:.1f} MB at {settled[-1][0]:.0f} s, at most {max(s[1] for s in samples):.1f} MB")
    print(f"growth of the memory       {slope:+.2f} MB an hour since {settled[0][0]:.0f} s"
          + ("" if is_long else " (too short a run to count)"))
    print(f"threads                    {threads_before:.0f} in the first half, {threads_after:.0f} in the second, "
          f"at most {max(s[2] for s in samples):.0f}")
    print(f"CPU                        {100.0 * samples[-1][3] / length_s:.0f} % of a core")
    grows = threads_after > threads_before or (is_long and slope >= MAX_SLOPE_MB_PER_H)
    return 1 if grows else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
