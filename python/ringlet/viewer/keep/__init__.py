"""What a review keeps, compares and passes on: snapshots, notes, references, views and share pages."""
