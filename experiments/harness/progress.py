"""A line on a terminal that shows how far a study is; elsewhere a line every tenth."""
import time


class Progress:
    def __init__(self, name, units, done_before, waiting, stream):
        self.name, self.waiting, self.stream = name, waiting, stream
        self.done, self.begin = 0, time.monotonic()
        self.terminal = getattr(stream, 'isatty', lambda: False)()
        self.print(f'{name}: {units} units, {done_before} of them done before\n')

    def print(self, text):
        self.stream.write(text)
        self.stream.flush()

    def note(self, text):
        self.print(('\r\033[K' if self.terminal else '') + text + '\n')

    def step(self):
        self.done += 1
        left = (time.monotonic() - self.begin) / self.done * (self.waiting - self.done)
        bar = '#' * round(30 * self.done / self.waiting)
        line = f'{self.name} [{bar:<30}] {self.done}/{self.waiting}, {clock(left)} left'
        if self.terminal:
            self.print(f'\r\033[K{line}')
        elif self.done == self.waiting or self.done * 10 // self.waiting > (self.done - 1) * 10 // self.waiting:
            self.print(line + '\n')

    def end(self):
        if self.terminal and self.waiting:
            self.print('\n')


def clock(seconds):
    minutes, seconds = divmod(round(seconds), 60)
    return f'{minutes // 60}:{minutes % 60:02d}:{seconds:02d}'
