"""Where the results of a sweep lie: files of a folder or object store, chunks, the stamp."""
