"""Do the article's statements survive other choices of what it does not say?"""
