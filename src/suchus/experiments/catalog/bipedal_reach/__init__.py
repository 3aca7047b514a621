"""How high does it reach, crawling and standing on two legs?"""
