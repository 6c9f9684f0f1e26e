"""For developers: finds the texts of the page and keeps the catalogues of `app.languages`."""
