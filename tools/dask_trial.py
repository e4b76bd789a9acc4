"""What tools/dask_here --try runs: an executor of a Dask cluster of 4 processes, one of which is killed on the way.

It prints what a study over such an executor has to count on, and ends with status 1 if a result is missing.
"""

import concurrent.futures
import os
import signal
import time

from distributed import Client, LocalCluster


def work(number):
    time.sleep(0.5)
    return number * number, os.getpid()


def fail(number):
    raise ValueError(f"no result for {number}")


def die(number):
    os.kill(os.getpid(), signal.SIGKILL)


def main():
    with (
        LocalCluster(n_workers=4, threads_per_worker=1, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        executor = client.get_executor(pure=False)  # by default, equal calls share a result, or a cancellation
        print(f"an Executor of concurrent.futures: {isinstance(executor, concurrent.futures.Executor)}")
        futures = [executor.submit(work, number) for number in range(8)]
        print(f"its futures are those of concurrent.futures: {isinstance(futures[0], concurrent.futures.Future)}")
        time.sleep(0.7)
        victim = next(iter(client.processing()))
        os.kill(client.run(os.getpid)[victim], signal.SIGKILL)
        results = {future.result(timeout=60) for future in concurrent.futures.as_completed(futures, timeout=60)}
        squares = sorted(square for square, _ in results)
        print(f"one process killed: {len(squares)} of 8 results, from {len({process for _, process in results})} processes")
        for function in (fail, die):
            try:
                executor.submit(function, 1).result(timeout=120)
            except Exception as error:  # noqa: BLE001 (it is what is looked at)
                print(f"{function.__name__}: {type(error).__module__}.{type(error).__name__}: {str(error)[:120]}")
        return squares == [number * number for number in range(8)]


if __name__ == "__main__":
    raise SystemExit(not main())
