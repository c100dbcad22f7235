"""Impulses at contacts, and whole steps."""
