"""Work cut into chunks: the jobs, the chunks here or on workers, and the stores that keep their results."""
